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
from ...translations import counted, translate
from ..reports import clearance_text, report_error

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
        return translate("No intersections")
    faces = counted(pairs.total(), "1 intersecting face pair", "{} intersecting face pairs")
    if triangle_pairs != pairs.total():
        faces += f" ({counted(triangle_pairs, '1 triangle pair', '{} triangle pairs')})"
    objects = counted(len({name for pair in pairs for name in pair}), "1 object", "{} objects")
    lines = [translate("{} in {}").format(faces, objects)]
    if selected:
        lines[0] += ", " + counted(sum(selected.values()), "1 face selected", "{} faces selected")
    for (first, second), count in pairs.most_common(MAX_PAIRS):
        itself = translate("{}: {} with itself").format(first, count)
        lines.append(itself if first == second else f"{first}, {second}: {count}")
    if len(pairs) > MAX_PAIRS:
        lines.append(translate("and {} more").format(len(pairs) - MAX_PAIRS))
    return "\n".join(lines)


def tested(found: stiv_blender.SceneCheck) -> str:
    """The tested objects and triangles, and the objects that were not tested, as a line."""
    objects = counted(found.objects, "1 object", "{} objects")
    triangles = counted(found.triangles, "1 triangle", "{} triangles")
    parts = [translate("Tested {}, {}").format(objects, triangles)]
    if found.seams:
        parts.append(counted(found.seams, "1 face pair on seams", "{} face pairs on seams"))
    if found.untested:
        parts.append(translate("not tested, {}").format(stiv_blender.untested_text(found.untested)))
    return "; ".join(parts)


def clearance(context: bpy.types.Context) -> str:
    """The smallest distance between two objects as a line, also shown in the view; "" without two objects."""
    least = stiv_blender.nearest_pair(context, edit_settings(context.scene))
    display.show_clearance(least)
    return "" if least is None else clearance_text(least)


def select(context: bpy.types.Context, names: Collection[str]) -> None:
    """Select the objects with these names, and deselect all others."""
    for obj in context.view_layer.objects:
        obj.select_set(obj.name in names)
