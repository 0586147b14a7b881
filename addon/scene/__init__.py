# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads Blender's scene for an edit: pivot and orientation, tool settings, the settings of the edit."""
