# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of files for builds: what is found, baselines, reports and pictures. Knows nothing of Blender."""
