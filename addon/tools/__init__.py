# SPDX-License-Identifier: GPL-3.0-or-later
"""The tools of the toolbar, their gizmo, and the switch that lets Blender's own transforms collide."""
