# SPDX-License-Identifier: GPL-3.0-or-later
"""What of the obstacles is too far to matter to an edit yet, and the box that what moves must not leave meanwhile."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from stiv.blender.controls.movers import Mover
from stiv.blender.scene.arrays import Floats, as_matrix, transform_points
from stiv.blender.scene.dependencies import dependencies
from stiv.blender.scene.evaluated_scene import SURFACE_TYPES, is_visible
from stiv.blender.scene.evaluations import RENDER, VIEWPORT, signature
from stiv.blender.settings import EditSettings

LEAST_FACES = 50_000  # of obstacles: below, all of them are taken in
LARGE = 20_000  # faces of one obstacle from which only its near part is taken in
MARGIN = 0.01  # of the size of the box, which what moves keeps from its sides


@dataclass(frozen=True)
class Reach:
    """The box from `low` to `high`, (3,), and the separation to be kept.

    Nothing named in `left_out` touches it; of what is named in `cropped` only what touches it takes part.
    """

    low: Floats
    high: Floats
    left_out: frozenset[str]
    cropped: frozenset[str]
    separation: float = 0.0

    def box_of(self, name: str) -> tuple[Floats, Floats] | None:
        """What part of an object takes part, (3,) and (3,); None: all of it."""
        return (self.low, self.high) if name in self.cropped else None

    def contains(self, points: Floats) -> bool:
        """Are all points, (n, 3), within the box, a margin and twice the separation away from its sides?"""
        margin = MARGIN * float(np.linalg.norm(self.high - self.low)) + 2 * self.separation
        return bool(((points >= self.low + margin) & (points <= self.high - margin)).all())


def find_reach(
    context: bpy.types.Context,
    movers: Sequence[Mover],
    settings: EditSettings,
    beyond: Floats = np.empty((0, 3)),  # noqa: B008 (never written)
) -> Reach | None:
    """What movers cannot meet without moving farther than their own size; None where nothing is gained.

    With points, (n, 3), where they are to go: than the size of all of that.
    Left out, or cropped where they are large, are only meshes that stand alone: what is tied to others by parents,
    modifiers, constraints or instances, or named in the settings, is always taken in.
    """
    objects = [ob for ob in context.view_layer.objects if is_visible(context, ob)]
    candidates = [ob for ob in objects if _stands_alone(ob) and _is_alike(ob, context.scene)]
    if sum(len(ob.data.polygons) for ob in candidates) < LEAST_FACES:
        return None
    named = {*settings.named_objects(), *settings.excluded.shapes}
    linked = tied(objects, {mover.reference.name for mover in movers})
    depsgraph = context.evaluated_depsgraph_get()
    moving = [_box(ob, depsgraph) for ob in objects if ob.name in linked and ob.type in SURFACE_TYPES]
    if not moving:
        return None
    low = np.min([*(box[0] for box in moving), *beyond], axis=0)
    high = np.max([*(box[1] for box in moving), *beyond], axis=0)
    size = float(np.linalg.norm(high - low)) + 2 * settings.separation
    low, high = low - size, high + size
    free = [ob for ob in candidates if ob.name not in linked | named]
    far = frozenset(ob.name for ob in free if _apart(_box(ob, depsgraph), (low, high)))
    cropped = frozenset(
        ob.name for ob in free
        if ob.name not in far and len(ob.data.polygons) >= LARGE and not _holds((low, high), _box(ob, depsgraph))
    )  # fmt: skip
    return Reach(low, high, far, cropped, settings.separation) if far or cropped else None


def _stands_alone(ob: bpy.types.Object) -> bool:
    alone = ob.type == "MESH" and ob.mode == "OBJECT" and ob.instance_type == "NONE"
    return bool(alone and ob.parent is None and not ob.children and not any(dependencies(ob)))


def _is_alike(ob: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Is the object rendered as it is shown, so that its bounds hold for both?"""
    return signature(ob, scene, VIEWPORT) == signature(ob, scene, RENDER)


def tied(objects: Sequence[bpy.types.Object], names: set[str]) -> set[str]:
    """The names, and all that hang on them or look at them, directly or not."""
    users = {ob.name: {each.used for each in dependencies(ob)} for ob in objects}
    for ob in objects:
        if ob.parent is not None:
            users[ob.name].add(ob.parent.name)
    found, before = set(names), -1
    while len(found) != before:
        before = len(found)
        found |= {name for name, used in users.items() if used & found}
    return found


def _box(ob: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> tuple[Floats, Floats]:
    """The bounds of an evaluated object in the world, (3,) each."""
    evaluated = ob.evaluated_get(depsgraph)
    corners = transform_points(
        as_matrix(evaluated.matrix_world), np.array([list(each) for each in evaluated.bound_box])
    )
    return corners.min(axis=0), corners.max(axis=0)


def _holds(outer: tuple[Floats, Floats], inner: tuple[Floats, Floats]) -> bool:
    return bool((outer[0] <= inner[0]).all() and (inner[1] <= outer[1]).all())


def _apart(a: tuple[Floats, Floats], b: tuple[Floats, Floats]) -> bool:
    return bool((a[0] > b[1]).any() or (b[0] > a[1]).any())
