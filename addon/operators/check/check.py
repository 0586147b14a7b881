# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.check`: finds intersections in the current scene, and selects the intersecting objects and faces."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping

import bpy

from ... import stiv_blender
from ...native_module import NeedsNativeModule
from ...overlay import display
from ...scene.edit_settings import edit_settings
from ..reports import clearance_text, counted, report_error

MAX_PAIRS = 5  # pairs of objects that the summary lists


class STIV_OT_check(NeedsNativeModule, bpy.types.Operator):
    """Find intersections of all visible surfaces with an exact test, and select them"""

    bl_idname = "stiv.check"
    bl_label = "Check for Intersections"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Check, show, select."""
        try:
            found = stiv_blender.check_scene(context, edit_settings(context.scene))
        except ValueError as error:
            return report_error(self, error)
        pairs = Counter((pair.first.object, pair.second.object) for pair in found.pairs)
        if pairs and context.mode == "OBJECT":
            select(context, {name for pair in pairs for name in pair})
        selected = stiv_blender.select_faces(context, stiv_blender.faces_of(found.pairs)) if pairs else {}
        lines = [summary(pairs, found.triangle_pairs, selected), "" if pairs else clearance(context), tested(found)]
        text = "\n".join(filter(None, lines))
        context.window_manager.stiv_check.summary = text
        display.show_pairs(context, found.pairs)
        self.report({"WARNING"} if pairs else {"INFO"}, text.splitlines()[0])
        return {"FINISHED"}


def summary(pairs: Counter[tuple[str, str]], triangle_pairs: int, selected: Mapping[str, int]) -> str:
    """Intersecting pairs of faces and of triangles, the number of selected faces, and the pairs of objects."""
    if not pairs:
        return "No intersections"
    faces = f", {counted(sum(selected.values()), 'face')} selected" if selected else ""
    triangles = f" ({counted(triangle_pairs, 'triangle pair')})" if triangle_pairs != pairs.total() else ""
    objects = counted(len({name for pair in pairs for name in pair}), "object")
    lines = [f"{counted(pairs.total(), 'intersecting face pair')}{triangles} in {objects}{faces}"]
    for (first, second), count in pairs.most_common(MAX_PAIRS):
        lines.append(f"{first}: {count} with itself" if first == second else f"{first}, {second}: {count}")
    if len(pairs) > MAX_PAIRS:
        lines.append(f"and {counted(len(pairs) - MAX_PAIRS, 'more object pair')}")
    return "\n".join(lines)


def tested(found: stiv_blender.SceneCheck) -> str:
    """The tested objects and triangles, and the objects that were not tested, as a line."""
    left_out = f"; not tested, {stiv_blender.left_out_text(found.left_out)}" if found.left_out else ""
    seams = f"; {counted(found.seams, 'face pair')} on seams" if found.seams else ""
    return f"Tested {counted(found.objects, 'object')}, {counted(found.triangles, 'triangle')}{seams}{left_out}"


def clearance(context: bpy.types.Context) -> str:
    """The smallest distance between two objects as a line, also shown in the view; "" without two objects."""
    least = stiv_blender.nearest_pair(context, edit_settings(context.scene))
    display.show_clearance(least)
    return "" if least is None else clearance_text(least)


def select(context: bpy.types.Context, names: Collection[str]) -> None:
    """Select the objects with these names, and deselect all others."""
    for obj in context.view_layer.objects:
        obj.select_set(obj.name in names)
