# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of files in builds, without Blender: findings, baselines, reports and pictures."""
