# SPDX-License-Identifier: GPL-3.0-or-later
"""The one place that reads a Blender scene and writes controls back."""
