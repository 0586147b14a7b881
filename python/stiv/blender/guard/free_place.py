# SPDX-License-Identifier: GPL-3.0-or-later
"""The nearest place where new objects intersect nothing."""

from __future__ import annotations

import itertools
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv.blender.guard.new_parts import split_parts
from stiv.blender.scene.arrays import Flags, Floats, Indices
from stiv.blender.scene.assembly import Assembly, assemble
from stiv.blender.scene.guarded_evaluations import read_guarded_scene
from stiv.blender.settings import EditSettings
from stiv.blender.verify.scene_check import tested_names
from stiv.deadlines import deadline_after, is_over
from stiv.task import Steps

DIRECTIONS = sorted(
    (np.array(each) / np.linalg.norm(each) for each in itertools.product((-1, 0, 1), repeat=3) if any(each)),
    key=lambda each: float(-np.abs(each).max()),
)
"""Along the axes, then between two and three of them."""
FIRST_STEP, GROWTH = 1 / 64, 1.5  # of the new objects' diagonal; each step out is longer
BISECTIONS = 8
MARGIN = 1e-3  # added to the shortest free distance
TIME_LIMIT, LEAST_TIME = 2.0, 0.5  # seconds of a search; the second holds after the deadline


def find_free_place(
    context: bpy.types.Context,
    settings: EditSettings,
    names: Collection[str],
    end: float,
    parts: Mapping[str, Flags] | None = None,
) -> Steps[Floats | None]:
    """Steps to the shortest translation found, (3,), that frees the named objects from all others; None without one.

    end: the deadline; then the best place so far is returned, or the first one found later. parts: flags of vertices
    that move, by object, instead of whole objects. All that moves stays together, and intersections within it are not
    counted. Places inside a closed surface do not count. A free place gives 0.
    """
    scene, _ = read_guarded_scene(context, settings, tested_names(context, settings), strands=True)
    split = split_parts(scene.meshes, parts or {})
    mobility = ["rigid" if is_part or mesh.owner.name in names else "fixed" for mesh, is_part in split]
    moving = frozenset({*names, *(parts or {})})
    assembly = assemble([mesh for mesh, _ in split], mobility, [moving], settings.ignored_pairs)
    search = _Search.of(assembly, [index for index, kind in enumerate(mobility) if kind == "rigid"], settings.threads)
    if search is None:
        return None
    if search.is_free(np.zeros(3)):
        return np.zeros(3)
    best, deadline = np.inf, min(deadline_after(TIME_LIMIT), max(end, deadline_after(LEAST_TIME)))
    found = None
    for direction in DIRECTIONS:
        distance = yield from search.free_distance(direction, best, deadline)
        if distance < best:
            best, found = distance, direction * distance
    return found


@dataclass(frozen=True)
class _Search:
    """Tests translations of some vertices against all others."""

    assembly: Assembly
    moving: NDArray[np.bool_]
    test: stiv.IntersectionTest
    others: list[Indices]
    size: float
    extent: float

    @staticmethod
    def of(assembly: Assembly, meshes: list[int], threads: int) -> _Search | None:
        if not meshes or len(meshes) == len(assembly.meshes):
            return None
        moving = np.zeros(len(assembly.positions), np.bool_)
        moving[assembly.vertices_of(meshes)] = True
        if not moving.any() or moving.all():
            return None
        triangles = assembly.surface.triangles
        bodies = np.asarray(assembly.surface.vertex_body)[triangles[:, 0]]
        fixed = ~moving[triangles[:, 0]]
        others = [triangles[fixed & (bodies == body)] for body in np.unique(bodies[fixed])]
        size = float(np.linalg.norm(np.ptp(assembly.positions[moving], axis=0)))
        extent = size + float(np.linalg.norm(np.ptp(assembly.positions, axis=0)))
        test = stiv.IntersectionTest(assembly.surface, threads)
        return _Search(assembly, moving, test, others, size, extent)

    def free_distance(self, direction: Floats, limit: float, deadline: float) -> Steps[float]:
        """Steps to the shortest free distance found along a direction, below a limit, with a margin; else infinity."""
        low, step = 0.0, self.size * FIRST_STEP
        high = step
        while not self.is_free(direction * high):
            yield None
            low, step = high, step * GROWTH
            high += step
            is_late = np.isfinite(limit) and is_over(deadline)
            if is_late or low > min(limit, self.extent):
                return float("inf")
        for _ in range(BISECTIONS):
            yield None
            middle = (low + high) / 2
            low, high = (low, middle) if self.is_free(direction * middle) else (middle, high)
        padded = high + MARGIN * self.size
        return padded if self.is_free(direction * padded) else high

    def is_free(self, translation: Floats) -> bool:
        q = self.assembly.positions + self.moving[:, None] * translation
        return len(self.test.find(q)) == 0 and not self._is_inside(q)

    def _is_inside(self, q: Floats) -> bool:
        """Is a moving vertex inside another closed surface?"""
        point = q[np.flatnonzero(self.moving)[0]]
        return any(abs(_winding_number(q[triangles], point)) > 0.5 for triangles in self.others)


def _winding_number(corners: Floats, point: Floats) -> float:
    """Winding number of triangles, (f, 3, 3), around a point: the sum of their solid angles over 4 pi."""
    a, b, c = np.moveaxis(corners - point, 1, 0)
    la, lb, lc = (np.linalg.norm(each, axis=1) for each in (a, b, c))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    products = (np.einsum("ij,ij->i", *pair) for pair in ((a, b), (b, c), (c, a)))
    ab, bc, ca = products
    return float(np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb).sum() / (2 * np.pi))
