# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.check`: finds intersections in the current scene, and may select the intersecting objects and faces."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty

from ... import stiv_blender
from ...intersection_texts import details, headline
from ...overlay import display
from ...scene.edit_settings import edit_settings
from ...translations import counted, translate
from ..finding_operator import FindingOperator
from ..repair.passing import passing_text
from ..reports import clearance_text


class STIV_OT_check(FindingOperator, bpy.types.Operator):
    """Find intersections of all visible surfaces with an exact test"""

    bl_idname = "stiv.check"
    bl_label = "Collision Check"
    sets = False

    select: BoolProperty(
        name="Select Intersecting Faces",
        description="Select the objects and faces that intersect, and deselect all others",
        default=False,
    )

    def find(self, context: bpy.types.Context) -> stiv_blender.SceneCheck:
        """Check."""
        return stiv_blender.check_scene(context, edit_settings(context.scene))

    def take(self, context: bpy.types.Context, found: stiv_blender.SceneCheck) -> None:
        """Show, and select if asked to."""
        if self.select and found.pairs:
            select(context, found.pairs)
        lines = [headline(found.pairs, translate), *details(found.pairs, translate)]
        text = "\n".join(filter(None, lines)) or translate("No intersections")
        near = "" if found.pairs else clearance(context)
        lines = [text, near, *tested(found), passing_text(context.scene)]
        result = context.window_manager.stiv_check
        result.summary, result.intersects = "\n".join(filter(None, lines)), bool(found.pairs)
        display.show_pairs(context, found.pairs)
        self.report({"WARNING"} if found.pairs else {"INFO"}, text.splitlines()[0])


def tested(found: stiv_blender.SceneCheck) -> list[str]:
    """Lines on the tested objects and triangles, and the objects that were not tested."""
    objects = counted(found.objects, "1 object", "{} objects")
    triangles = counted(found.triangles, "1 triangle", "{} triangles")
    lines = [translate("Tested {}, {}").format(objects, triangles)]
    if found.seams:
        lines.append(counted(found.seams, "1 contact on a seam", "{} contacts on seams"))
    if found.untested:
        lines.append(translate("Not tested: {}").format(stiv_blender.untested_text(found.untested)))
    return lines


def clearance(context: bpy.types.Context) -> str:
    """The smallest distance between two objects as a line, also shown in the view; "" without two objects."""
    least = stiv_blender.nearest_pair(context, edit_settings(context.scene))
    display.show_clearance(least)
    return "" if least is None else clearance_text(least)


def select(context: bpy.types.Context, pairs: stiv_blender.FacePairs) -> None:
    """Select the objects and faces in the pairs, and deselect all others."""
    if context.mode == "OBJECT":
        names = {name for both in pairs.by_objects() for name in both}
        for obj in context.view_layer.objects:
            obj.select_set(obj.name in names)
    stiv_blender.select_faces(context, stiv_blender.faces_of(pairs))
