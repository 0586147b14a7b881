# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a rigid body can travel among obstacles, and what it touches or intersects. Without Blender."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import stiv
from stiv.blender.layout.rigid_scene import RigidScene
from stiv.blender.scene.arrays import Flags, Floats
from stiv.task import Steps

STRIDE = 0.25  # of its size, that a body travels between two searches for obstacles
SHORTEST_STRIDE = 1e-3  # of the whole way, for bodies without a size
DRIFT = 1e-4  # of a distance below the separation, that a search after the first may lose to rounding
TOLERANCE = 0.02  # of the separation; a body that starts this much nearer may stay

HERE = np.zeros((2, 3))


@dataclass(frozen=True)
class Contact:
    """A point of a mover, (3,), its distance to an obstacle there, and the minimum distance between the two.

    `normal`, (3,), is the direction from the obstacle to the mover.
    """

    point: Floats
    distance: float
    separation: float
    normal: Floats


def travel(scene: RigidScene, mover: int, vector: Floats, among: Flags | None = None) -> Steps[float | None]:
    """Steps that find the fraction of a displacement, (3,), at which a mover stops; None if it is free.

    It stops at the minimum distance; if it starts nearer than that, where it comes nearer yet. among: see
    `RigidScene.facing`.
    """
    length = max(float(np.linalg.norm(vector)), 1e-300)
    step = min(1.0, max(STRIDE * scene.size(mover) / length, SHORTEST_STRIDE))
    for number in range(int(np.ceil(1 / step))):
        ends = np.array([number * step, min(1.0, (number + 1) * step)])
        nearer = TOLERANCE if number == 0 else DRIFT
        time = _earliest_time(scene, mover, ends[:, None] * vector, among, 1 - nearer)
        if time <= 1:
            return float(ends[0] + time * (ends[1] - ends[0]))
        yield None
    return None


def _earliest_time(scene: RigidScene, mover: int, offsets: Floats, among: Flags | None, ratio: float) -> float:
    """The time in [0, 1] of the first stop between two offsets of a mover, (2, 3); infinity without one."""
    first = np.inf
    for each in scene.facing(mover, offsets, among):
        detector = stiv.Detector(each.surface, threads=scene.threads)
        start, end = (each.moved(offset) for offset in offsets)
        first = min(first, detector.earliest_time(start, end, each.separation, ratio))
    return first


def is_clear(scene: RigidScene, mover: int, among: Flags | None = None) -> bool:
    """Is a mover at least the minimum distance away from everything? Does not look inside closed surfaces."""
    for each in scene.facing(mover, HERE, among):
        q = each.positions
        if len(stiv.find_intersections(q, each.surface, threads=scene.threads)):
            return False
        least = stiv.least_distance(q, each.surface)
        if least is not None and least.distance < each.separation:
            return False
    return True


def find_intersected(scene: RigidScene, mover: int) -> str:
    """The name of a body that intersects a mover; "" if none does."""
    for each in scene.facing(mover, HERE):
        q = each.positions
        pairs = stiv.find_intersections(q, each.surface, threads=scene.threads)
        if len(pairs):
            corners = each.surface.triangles[pairs[0], 0]
            return scene.name_at(int(each.rows[corners.max()]))
    return ""


def find_nearest(scene: RigidScene, mover: int) -> tuple[Floats, float] | None:
    """The vector, (3,), from a mover to the nearest obstacle, and the minimum distance there; None without one."""
    best: tuple[Floats, float] | None = None
    for each in scene.facing(mover, None):
        q = each.positions
        least = stiv.least_distance(q, each.surface)
        if least is None:
            continue
        own = each.surface.triangles[least.triangles[0], 0] < each.count
        vector = (least.points[1] - least.points[0]) * (1 if own else -1)
        if best is None or np.linalg.norm(vector) < np.linalg.norm(best[0]):
            best = (vector, each.separation)
    return best


def find_contacts(scene: RigidScene, mover: int, direction: Floats, reach: float) -> list[Contact]:
    """Where obstacles stop a mover within `reach` minimum distances along a direction."""
    found = []
    for each in scene.facing(mover, HERE, margin=1 + reach):
        here, there = each.positions, each.moved(reach * each.separation * direction)
        detector = stiv.Detector(each.surface, threads=scene.threads)
        events = detector.find(here, there, each.separation, 1 - TOLERANCE)
        for vertices, weights, start in zip(events.vertices, events.weights, events.start_distance, strict=True):
            own = vertices < each.count
            point = np.abs(weights[own]) @ here[vertices[own]]
            away = (weights @ here[vertices]) * (1 if own[0] else -1)
            unit = away / max(float(np.linalg.norm(away)), 1e-300)
            found.append(Contact(point, float(start), each.separation, unit))
    return found


def contact_normals(scene: RigidScene, mover: int, among: Flags | None = None) -> Floats:
    """Normals, (k, 3), of the triangles of both sides that intersect, and the vector between the closest points."""
    normals = [np.empty((0, 3))]
    for each in scene.facing(mover, HERE, among):
        q = each.positions
        pairs = stiv.find_intersections(q, each.surface, threads=scene.threads)
        corners = q[each.surface.triangles[np.unique(pairs)]]
        normals.append(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
        least = None if len(pairs) else stiv.least_distance(q, each.surface)
        if least is not None:
            normals.append((least.points[1] - least.points[0])[None])
    found: Floats = np.concatenate(normals)
    lengths = np.linalg.norm(found, axis=1)
    unit: Floats = found[lengths > 0] / lengths[lengths > 0, None]
    return unit
