# SPDX-License-Identifier: GPL-3.0-or-later
"""The tools of the toolbar: one group below Blender's own transforms, in each mode that they support."""

from __future__ import annotations

import bpy

from ..operators.transform.start_drag import BLENDER_OPERATORS

TOOL_MODES = ("OBJECT", "POSE", "EDIT_MESH", "EDIT_LATTICE", "EDIT_CURVE", "EDIT_SURFACE")
KINDS = ("move", "rotate", "scale")
DESCRIPTIONS = {
    "move": "Move the selection; surfaces collide instead of intersecting",
    "rotate": "Rotate the selection; surfaces collide instead of intersecting",
    "scale": "Scale the selection; surfaces collide instead of intersecting",
}


def draw_settings(context: bpy.types.Context, layout: bpy.types.UILayout, tool: bpy.types.WorkSpaceTool) -> None:
    """The settings in the tool header, and in the panel of the active tool."""
    settings = context.scene.stiv
    layout.prop(context.scene.transform_orientation_slots[0], "type")
    layout.prop(settings, "interference")
    layout.prop(settings, "responders")
    if context.mode == "OBJECT":
        layout.prop(settings, "object_response")
    elif context.mode == "POSE":
        layout.prop(settings, "joint_region")
    if settings.automatic_separation:
        layout.row(heading="Minimum Distance").prop(settings, "automatic_separation", text="Auto", toggle=True)
    else:
        row = layout.row(align=True)
        row.prop(settings, "separation")
        row.prop(settings, "automatic_separation", text="", icon="X")


def _make_tool(kind: str, mode: str) -> type[bpy.types.WorkSpaceTool]:
    drag = {"type": "LEFTMOUSE", "value": "CLICK_DRAG"}
    content = {
        "bl_space_type": "VIEW_3D",
        "bl_context_mode": mode,
        "bl_idname": f"stiv.collision_{kind}",
        "bl_label": f"Collision {kind.title()}",
        "bl_description": DESCRIPTIONS[kind],
        "bl_icon": f"ops.transform.{BLENDER_OPERATORS[kind]}",
        "bl_operator": f"stiv.{kind}",
        "bl_keymap": (("stiv.transform", drag, {"properties": [("kind", kind), ("release_confirm", True)]}),),
        "draw_settings": staticmethod(draw_settings),
    }
    return type(f"STIV_WT_{kind}_{mode.lower()}", (bpy.types.WorkSpaceTool,), content)


_registered: list[type[bpy.types.WorkSpaceTool]] = []


def register() -> None:
    """Add the tools."""
    for mode in TOOL_MODES:
        before = "builtin.transform"
        for kind in KINDS:
            tool = _make_tool(kind, mode)
            bpy.utils.register_tool(tool, after={before}, group=kind == KINDS[0])
            _registered.append(tool)
            before = tool.bl_idname


def unregister() -> None:
    """Remove the tools and their keymaps, which Blender would keep."""
    configurations = bpy.context.window_manager.keyconfigs
    for tool in reversed(_registered):
        name = tool._bl_tool.keymap[0]
        bpy.utils.unregister_tool(tool)
        for configuration in (configurations.addon, configurations.default, configurations.user):
            keymap = configuration.keymaps.get(name) if configuration is not None else None
            if keymap is not None:
                configuration.keymaps.remove(keymap)
    _registered.clear()
