# SPDX-License-Identifier: GPL-3.0-or-later
"""Entries in Blender's own menus."""

from __future__ import annotations

import bpy

from .operators import TRANSFORMS
from .operators.check import STIV_OT_check

# Object > Transform; Mesh > Transform and Lattice > Transform, which are one menu.
MENUS = ("VIEW3D_MT_transform_object", "VIEW3D_MT_transform")


def draw(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    """Append the operators to a menu."""
    self.layout.separator()
    for operator in (*TRANSFORMS, STIV_OT_check):
        self.layout.operator(operator.bl_idname, text=operator.bl_label)


def register() -> None:
    """Append to the menus."""
    for name in MENUS:
        getattr(bpy.types, name).append(draw)


def unregister() -> None:
    """Leave the menus as they were."""
    for name in MENUS:
        getattr(bpy.types, name).remove(draw)
