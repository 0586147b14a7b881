# SPDX-License-Identifier: GPL-3.0-or-later
"""Which handles the gizmo of a 3D view has: those of its tool, or those that replace Blender's."""

from __future__ import annotations

import bpy

from .. import native_module
from ..operators.transform.start_drag import is_live
from ..operators.transform.transform_operator import MODES
from . import hidden_gizmos

ALL = frozenset({"move", "rotate", "scale"})
OWN_TOOLS = {f"stiv.collision_{kind}": frozenset({kind}) for kind in sorted(ALL)}
BLENDER_TOOLS = {f"builtin.{kind}": frozenset({kind}) for kind in sorted(ALL)} | {"builtin.transform": ALL}


def active_tool(context: bpy.types.Context) -> str:
    """The identifier of the active tool of the 3D view; empty if there is none."""
    tool = context.workspace.tools.from_space_view3d_mode(context.mode, create=False)
    return "" if tool is None else str(tool.idname)


def shown_kinds(context: bpy.types.Context) -> frozenset[str]:
    """The kinds of transforms that have handles in the 3D view of the context.

    If Blender's transforms collide, this hides Blender's handles in this view; otherwise it shows them again.
    """
    tool, space = active_tool(context), context.space_data
    live = is_live(context) and context.mode in MODES
    replaced = [hidden_gizmos.TOOL] if tool in BLENDER_TOOLS else []
    hidden_gizmos.hide_only(space, [*hidden_gizmos.OBJECT.values(), *replaced] if live else [])
    if native_module.problem() or context.mode not in MODES or not space.show_gizmo:
        return frozenset()
    found = OWN_TOOLS.get(tool) or (BLENDER_TOOLS.get(tool) if live else None)
    if found is not None:
        return found if hidden_gizmos.chosen(space, hidden_gizmos.TOOL) else frozenset()
    chosen = {kind for kind, name in hidden_gizmos.OBJECT.items() if live and hidden_gizmos.chosen(space, name)}
    return frozenset(chosen)
