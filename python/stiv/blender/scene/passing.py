# SPDX-License-Identifier: GPL-3.0-or-later
"""The pairs of objects that pass through each other (Let These Pass), as a scene stores them."""

from __future__ import annotations

from typing import Any

import bpy


def passing_pairs(scene: bpy.types.Scene) -> tuple[tuple[str, str], ...]:
    """Names of the objects of each pair, both in the scene. The extension that stores them may be disabled."""
    found = []
    for row in _stored(scene).get("passing_pairs", ()):
        objects = [row.get(which) for which in ("first", "second")]
        if all(each is not None and each.name in scene.objects for each in objects):
            found.append((objects[0].name, objects[1].name))
    return tuple(found)


def passing_note(pairs: tuple[tuple[str, str], ...]) -> str:
    """A note that names the pairs, which were not tested; "" without any."""
    listed = "; ".join(f'"{first}" and "{second}"' for first, second in pairs)
    return f"excluded, because they may pass through each other: {listed}" if pairs else ""


def _stored(scene: bpy.types.Scene) -> Any:
    """The extension's settings of a scene as plain properties. Blender 5 stores them apart from custom properties."""
    apart = hasattr(scene, "bl_system_properties_get")
    stored = (scene.bl_system_properties_get() or {}) if apart else scene
    return stored.get("stiv") or {}
