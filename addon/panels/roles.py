# SPDX-License-Identifier: GPL-3.0-or-later
"""How each selected object takes part."""

from __future__ import annotations

import bpy

from .drawing import MOST_OBJECTS, SubPanel


class STIV_PT_roles(SubPanel, bpy.types.Panel):
    """How each selected object takes part."""

    bl_idname = "STIV_PT_roles"
    bl_label = "Roles"

    def draw(self, context: bpy.types.Context) -> None:
        """One row an object."""
        chosen = [thing for thing in context.selected_objects if thing.type in {"MESH", "LATTICE"}]
        for thing in chosen[:MOST_OBJECTS]:
            row = self.layout.row()
            row.label(text=thing.name, icon=f"OUTLINER_OB_{thing.type}")
            row.prop(thing.stiv, "role", text="")
        if len(chosen) > MOST_OBJECTS:
            self.layout.label(text=f"and {len(chosen) - MOST_OBJECTS} more")
        if not chosen:
            self.layout.label(text="Select objects to see their roles")
