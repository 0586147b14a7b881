# SPDX-License-Identifier: GPL-3.0-or-later
"""The least translation found that separates some bodies of a surface from all others."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv.arrays import Floats, as_floats, as_number
from stiv.deadlines import deadline_after, is_over
from stiv.intersections import IntersectionTest
from stiv.surface import Surface
from stiv.task import Steps, run

_DIRECTIONS = 96  # on the sphere
_BISECTIONS = 14  # of a distance: to a 16,000th
_TILTS = (0.4, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005)  # of the best direction, refined; radians
_AROUND = 6  # directions of each tilt
_SHORTEST = 2.0**-40  # of the extent; bodies that only touch part by any distance
_WORTHWHILE = 1 - 2.0**-10  # of the best distance; a smaller gain is not sought


def find_separation(
    surface: Surface,
    vertices: ArrayLike,
    moving: ArrayLike,
    separation: float = 0.0,
    threads: int = 0,
    time_budget: float = 0.0,
) -> Floats | None:
    """Return the least translation found, (3,), of the moving vertices after which no triangles intersect.

    surface     Surface in which pairs of bodies that cannot part, such as two moving ones, do not meet
    vertices    (N, 3) positions
    moving      (N,) true for the vertices of the bodies that move
    separation  how far beyond the first clear place, if there is room
    time_budget in seconds, after which the least translation so far is the result; 0: no limit

    The distance is the least in the best of many directions, refined to a fraction of a percent. The result is exact in
    that nothing intersects there, and that no body lies inside another. Returns None if no direction is clear; a
    translation of 0 if nothing intersects.
    """
    return run(find_separation_steps(surface, vertices, moving, separation, threads, time_budget))


def find_separation_steps(
    surface: Surface,
    vertices: ArrayLike,
    moving: ArrayLike,
    separation: float = 0.0,
    threads: int = 0,
    time_budget: float = 0.0,
) -> Steps[Floats | None]:
    """Return the steps of :func:`find_separation`, which give a turn before each exact test."""
    q = as_floats(vertices, "vertices", (surface.vertex_count, 3))
    search = _Search(surface, q, np.asarray(moving, bool), threads, deadline_after(time_budget))
    if search.is_clear(np.zeros(3)):
        return np.zeros(3)
    found = yield from search.best_translation()
    if found is None:
        return None
    distance = float(np.linalg.norm(found))
    further = found * (1 + as_number(separation, "separation", 0) / distance)
    return further if search.is_clear(further) else found


class _Search:
    """Searches directions; `is_clear` decides."""

    def __init__(self, surface: Surface, q: Floats, moving: NDArray[np.bool_], threads: int, end: float) -> None:
        self._surface, self._q, self._moving, self._end = surface, q, moving, end
        self._test = IntersectionTest(surface, threads)
        self._shortest = _SHORTEST * float(np.ptp(q, axis=0).max(initial=0.0))
        bodies = np.unique(surface.vertex_body[surface.triangles[:, 0]], return_index=True)[1]
        self._seeds = surface.triangles[bodies, 0]  # a vertex of each body

    def is_clear(self, translation: Floats) -> bool:
        q = self._q + np.where(self._moving[:, None], translation, 0.0)
        return len(self._test.find(q)) == 0 and not self._has_body_inside(q)

    def best_translation(self) -> Steps[Floats | None]:
        best: Floats | None = None
        directions, tilts = self._directions(), np.repeat(_TILTS, _AROUND)
        total = len(directions) + len(tilts)
        for number, direction in enumerate(directions):
            yield number / total
            if is_over(self._end):
                return best
            best = yield from self._improved(best, direction)
        chance = np.random.default_rng(0)
        for number, tilt in enumerate(tilts):
            yield (len(directions) + number) / total
            if is_over(self._end):
                return best
            if best is not None:
                direction = best / np.linalg.norm(best) + tilt * chance.normal(size=3)
                best = yield from self._improved(best, direction)
        return best

    def _directions(self) -> Floats:
        """Directions on the sphere, the axes and the normals of the intersecting triangles; the shortest way first."""
        around = np.arange(_DIRECTIONS) + 0.5
        height, angle = 1 - 2 * around / _DIRECTIONS, np.pi * (1 + 5**0.5) * around
        ring = np.sqrt(1 - height**2)
        sphere = np.stack([ring * np.cos(angle), ring * np.sin(angle), height], axis=1)
        every = np.concatenate([np.eye(3), -np.eye(3), self._normals(), sphere])
        sorted_by_length: Floats = every[np.argsort([self._bound(each) for each in every], kind="stable")]
        return sorted_by_length

    def _normals(self) -> Floats:
        """The mean normal of the intersecting triangles on each side, both ways."""
        a, b, c = (self._q[self._surface.triangles[:, corner]] for corner in range(3))
        normals = np.cross(b - a, c - a)
        found = np.unique(self._test.find(self._q))
        moving = self._moving[self._surface.triangles[found, 0]]
        means = np.stack([normals[found[side]].sum(axis=0) for side in (moving, ~moving)])
        means = means[np.linalg.norm(means, axis=1) > 0]
        means /= np.linalg.norm(means, axis=1, keepdims=True)
        return np.concatenate([means, -means])

    def _bound(self, direction: Floats) -> float:
        """A distance after which all moving bodies lie beyond all others."""
        along = self._q @ direction
        return float(along[~self._moving].max(initial=-np.inf) - along[self._moving].min(initial=np.inf))

    def _improved(self, best: Floats | None, direction: Floats) -> Steps[Floats | None]:
        """The least clear translation along a direction if it is shorter than the best."""
        direction = direction / np.linalg.norm(direction)
        bound = self._bound(direction) * (1 + 1e-9)
        clear = bound if best is None else min(bound, float(np.linalg.norm(best)) * _WORTHWHILE)
        yield None
        if clear <= self._shortest or not self.is_clear(clear * direction):
            return best
        intersecting = 0.0
        for _ in range(_BISECTIONS):
            yield None
            if is_over(self._end):
                break
            middle = (intersecting + clear) / 2
            if self.is_clear(middle * direction):
                clear = middle
            else:
                intersecting = middle
        shortest: Floats = direction * clear
        return shortest

    def _has_body_inside(self, q: Floats) -> bool:
        """Does a body lie inside another one that moves against it?"""
        triangles, moving = self._surface.triangles, self._moving
        for side in (True, False):
            seeds = self._seeds[moving[self._seeds] == side]
            others = q[triangles[moving[triangles[:, 0]] != side]]
            if any(abs(_winding_number(others, q[seed])) > 0.5 for seed in seeds):
                return True
        return False


def _winding_number(triangles: Floats, point: Floats) -> float:
    """The winding number of triangles, (k, 3, 3), around a point. [van Oosterom, Strackee 1983]"""
    low, high = triangles.min(axis=(0, 1), initial=np.inf), triangles.max(axis=(0, 1), initial=-np.inf)
    if not ((point >= low) & (point <= high)).all():
        return 0.0
    a, b, c = np.moveaxis(triangles - point, 1, 0)
    x, y, z = (np.linalg.norm(each, axis=1) for each in (a, b, c))
    above = np.einsum("ij,ij->i", a, np.cross(b, c))
    dots = [np.einsum("ij,ij->i", *pair) for pair in ((a, b), (b, c), (c, a))]
    return float(np.arctan2(above, x * y * z + dots[0] * z + dots[1] * x + dots[2] * y).sum() / (2 * np.pi))
