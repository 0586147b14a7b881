# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv.check`: find intersections of the scene as it is, and select the objects they are in."""

from __future__ import annotations

from collections import Counter
from typing import Any

import bpy

from .. import availability
from ..settings import edit_settings

MOST = 5  # pairs of objects that the summary lists


class STIV_OT_check(bpy.types.Operator):
    """Find intersections of all visible surfaces by the exact test, and select the objects that they are in."""

    bl_idname = "stiv.check"
    bl_label = "Check for Intersections"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 (Blender reads a set)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """With the native module."""
        if availability.problem():
            cls.poll_message_set(availability.problem())
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Check, show, select."""
        from stiv.blender import check_scene  # the add-on registers without the native module

        try:
            found = check_scene(context, edit_settings(context.scene))
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        pairs = Counter((pair.first.object, pair.second.object) for pair in found.pairs)
        text = summary(pairs)
        context.window_manager.stiv_check.summary = text
        self.report({"WARNING"} if pairs else {"INFO"}, text.splitlines()[0])
        if pairs and context.mode == "OBJECT":
            select(context, {name for pair in pairs for name in pair})
        return {"FINISHED"}


def summary(pairs: Counter[tuple[str, str]]) -> str:
    """How many pairs of triangles meet, and in which objects; one line each."""
    if not pairs:
        return "No intersections"
    lines = [f"{pairs.total()} intersecting pairs of triangles"]
    for (first, second), count in pairs.most_common(MOST):
        lines.append(f"{first}: {count}, with itself" if first == second else f"{first}, {second}: {count}")
    if len(pairs) > MOST:
        lines.append(f"and {len(pairs) - MOST} more pairs of objects")
    return "\n".join(lines)


def select(context: bpy.types.Context, names: Any) -> None:
    """Select exactly the objects of these names."""
    for thing in context.view_layer.objects:
        thing.select_set(thing.name in names)
