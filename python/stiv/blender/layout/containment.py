# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether points are inside closed surfaces, by winding numbers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from stiv.blender.layout.rigid_scene import RigidScene
from stiv.blender.scene.arrays import Flags, Floats, Indices
from stiv.task import Steps

MAX_POINTS = 32  # vertices of a body that are tested
MOSTLY = 0.75  # of a body's box
CHUNK = 1 << 18  # pairs of a point and a triangle at once


def is_closed(triangles: Indices) -> bool:
    """Does each edge have as many triangles in one direction as in the other?"""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64)
    size = int(edges.max(initial=0)) + 1
    forward = np.sort(edges[:, 0] * size + edges[:, 1])
    backward = np.sort(edges[:, 1] * size + edges[:, 0])
    return len(edges) > 0 and bool(np.array_equal(forward, backward))


def winding_numbers(points: Floats, corners: Floats) -> Steps[Floats]:
    """Steps that find the winding numbers, (n,), of a surface, (f, 3, 3), around points, (n, 3).

    By the formula of van Oosterom and Strackee.
    """
    rows = max(1, CHUNK // max(len(corners), 1))
    parts = [np.zeros(0)]
    for first in range(0, len(points), rows):
        parts.append(_angles(points[first : first + rows], corners))
        yield None
    return np.concatenate(parts) / (2 * np.pi)


def _angles(points: Floats, corners: Floats) -> Floats:
    a, b, c = (corners[None, :, k] - points[:, None] for k in range(3))
    la, lb, lc = (np.linalg.norm(each, axis=2) for each in (a, b, c))
    volume = np.einsum("nfk,nfk->nf", a, np.cross(b, c))
    dots = [np.einsum("nfk,nfk->nf", *pair) for pair in ((a, b), (b, c), (c, a))]
    angles: Floats = np.arctan2(volume, la * lb * lc + dots[0] * lc + dots[1] * la + dots[2] * lb).sum(axis=1)
    return angles


def is_outside(scene: RigidScene, mover: int, among: Flags | None = None) -> Steps[bool]:
    """Steps that tell whether a sample of a mover's vertices is outside closed obstacles with outward normals."""
    points = scene.positions_of(mover)
    points = points[:: max(1, len(points) // MAX_POINTS)]
    for corners in _closed_around(scene, mover, among):
        if not bool(((yield from winding_numbers(points, corners)) < 0.5).all()):
            return False
    return True


def is_mostly_inside(scene: RigidScene, mover: int, among: Flags | None = None) -> Steps[bool]:
    """Steps that tell whether most of the box of a mover is inside a closed obstacle."""
    low, high = scene.box(mover)
    grid = np.stack(np.meshgrid(*[[-0.75, -0.25, 0.25, 0.75]] * 3), axis=-1).reshape(-1, 3)
    points = (low + high) / 2 + grid * (high - low) / 2
    for corners in _closed_around(scene, mover, among):
        if float((np.abs((yield from winding_numbers(points, corners))) > 0.5).mean()) >= MOSTLY:
            return True
    return False


def _closed_around(scene: RigidScene, mover: int, among: Flags | None) -> Iterator[Floats]:
    """The corners of each closed obstacle near a mover, (f, 3, 3)."""
    for body, triangles in scene.bodies_around(mover, among):
        if body not in scene.closed:
            scene.closed[body] = is_closed(triangles)
        if scene.closed[body]:
            yield scene.corners(triangles)
