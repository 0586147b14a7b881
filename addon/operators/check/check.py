# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.check`: find intersections of the scene as it is, and select the objects and faces they are in."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

import bpy

from ...native_module import NeedsNativeModule
from ...overlay import display
from ...scene.edit_settings import edit_settings

MOST = 5  # pairs of objects that the summary lists


class STIV_OT_check(NeedsNativeModule, bpy.types.Operator):
    """Find intersections of all visible surfaces with an exact test, and select them"""

    bl_idname = "stiv.check"
    bl_label = "Check for Intersections"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Check, show, select."""
        from stiv.blender import check_scene  # the add-on registers without the native module
        from stiv.blender.verify.face_selection import faces_of, select_faces

        try:
            found = check_scene(context, edit_settings(context.scene))
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        pairs = Counter((pair.first.object, pair.second.object) for pair in found.pairs)
        if pairs and context.mode == "OBJECT":
            select(context, {name for pair in pairs for name in pair})
        chosen = select_faces(context, faces_of(found.pairs)) if pairs else {}
        clearance = "" if pairs else read_out(context)
        text = f"{summary(pairs, found.triangle_pairs, chosen)}{clearance}\n{tested(found)}"
        context.window_manager.stiv_check.summary = text
        display.show_pairs(context, found.pairs)
        self.report({"WARNING"} if pairs else {"INFO"}, text.splitlines()[0])
        return {"FINISHED"}


def summary(pairs: Counter[tuple[str, str]], triangle_pairs: int, chosen: Mapping[str, int]) -> str:
    """How many pairs of faces and of triangles meet, in which objects, and how many faces are selected."""
    if not pairs:
        return "No intersections"
    faces = f", {counted(sum(chosen.values()), 'face')} selected" if chosen else ""
    triangles = f" ({counted(triangle_pairs, 'triangle pair')})" if triangle_pairs != pairs.total() else ""
    objects = counted(len({name for pair in pairs for name in pair}), "object")
    lines = [f"{counted(pairs.total(), 'intersecting face pair')}{triangles} in {objects}{faces}"]
    for (first, second), count in pairs.most_common(MOST):
        lines.append(f"{first}: {count} with itself" if first == second else f"{first}, {second}: {count}")
    if len(pairs) > MOST:
        lines.append(f"and {counted(len(pairs) - MOST, 'more object pair')}")
    return "\n".join(lines)


def tested(found: Any) -> str:
    """What took part in a check and what did not, as a line."""
    from stiv.checks.findings import left_out_text  # the add-on registers without the native module

    left_out = f"; not tested, {left_out_text(found.left_out)}" if found.left_out else ""
    seams = f"; {counted(found.seams, 'face pair')} on seams" if found.seams else ""
    return f"Tested {counted(found.objects, 'object')}, {counted(found.triangles, 'triangle')}{seams}{left_out}"


def counted(count: int, noun: str) -> str:
    """A number and its noun: "1 object", "1,200 objects"."""
    return f"{count:,} {noun}" if count == 1 else f"{count:,} {noun}s"


def read_out(context: bpy.types.Context) -> str:
    """The least distance between two objects as a line, shown in the view too; "" where there are not two."""
    from stiv.blender.verify.nearest_pair import nearest_pair  # the add-on registers without the native module

    least = nearest_pair(context, edit_settings(context.scene))
    display.show_clearance(least)
    if least is None:
        return ""
    return "\n" + clearance_text(least)


def clearance_text(least: Any) -> str:
    """A `stiv.LeastDistance` as a line."""
    return f"{' and '.join(least.bodies)}: clearance {least.distance:.6g}"


def select(context: bpy.types.Context, names: Any) -> None:
    """Select exactly the objects of these names."""
    for thing in context.view_layer.objects:
        thing.select_set(thing.name in names)
