# SPDX-License-Identifier: GPL-3.0-or-later
"""The least translation that parts bodies from others which they only touch, of the size of rounding."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv.arrays import Floats, Indices
from stiv.intersections import IntersectionTest, intersection_depths
from stiv.surface import Surface

_Flags = NDArray[np.bool_]

DEEPEST = 16  # of triangles that only touch, in roundings of their corners
DEEPEST_LEFT = 64  # after edits: each leaves 16 roundings of its coordinates, which may have been larger than now
SAME = 1e-5  # components of unit vectors that differ by less belong to one direction

_FIRST = 256  # pairs that are tested before all others; where surfaces cut each other, one of these mostly does
_SAMPLE = 4096  # pairs whose axes are compared
_MOST_AXES = 64  # directions that separate pairs, the most frequent ones
_MOST_CHOSEN = 8  # of these that a translation combines
_ROUNDS = 4  # of translations, after each of which other triangles may touch
_LONGEST = 8  # of a translation, in the depth and the gap of one contact


def rounding_of(points: Floats) -> float:
    """The distance of two numbers in single precision at the largest of some coordinates, (..., 3)."""
    return float(np.spacing(np.float32(np.abs(points).max(initial=0.0))))


def are_touching(first: Floats, second: Floats, depth: float | None = None) -> bool:
    """Return whether triangles, (k, 3, 3) each, cut no deeper into those of the same row.

    depth  that counts as touching; None: that of rounding
    """
    deepest, end = _tolerance(first, second) if depth is None else depth, len(first)
    parts = ((0, min(_FIRST, end)), (_FIRST, end))
    return all(depths_of(first[begin:stop], second[begin:stop]).max(initial=0.0) <= deepest for begin, stop in parts)


def depths_of(first: Floats, second: Floats) -> Floats:
    """How deep triangles, (k, 3, 3) each, cut into those of the same row, (k,)."""
    points = np.concatenate([first, second]).reshape(-1, 3)
    triangles = np.arange(len(points), dtype=np.int32).reshape(-1, 3)
    return intersection_depths(points, triangles, np.arange(len(triangles), dtype=np.int32).reshape(2, -1).T)


def find_parting(
    surface: Surface,
    vertices: Floats,
    moving: _Flags,
    gap: float,
    free: ArrayLike | None = None,
    near: Sequence[tuple[int, int]] = (),
    depth: float = 0.0,
    threads: int = 0,
) -> Floats | None:
    """Return the least translation found, (3,), of the moving vertices after which no triangles intersect.

    surface    Surface in which pairs of bodies that cannot part, such as two moving ones, do not meet
    vertices   (N, 3) positions
    moving     (N,) true for the vertices that move
    gap        distance by which those that touch are parted
    free       (3, 3) projection to the directions that the translation may have; None: all
    near       pairs of triangles, (k, 2), that do not touch but are nearer than the gap, and are parted too
    depth      that counts as touching, where that of rounding is not larger

    The result is exact in that nothing intersects there. Returns None if something cuts deeper than rounding, or
    no translation of that size parts everything.
    """
    test = IntersectionTest(surface, threads)
    allowed = np.eye(3) if free is None else np.asarray(free, np.float64)
    pairs, shift = np.array(near, np.int32).reshape(-1, 2), np.zeros(3)
    for number in range(_ROUNDS):
        found = test.find(vertices + np.where(moving[:, None], shift, 0.0))
        if len(found) == 0 and (number > 0 or len(pairs) == 0):
            return shift
        pairs = np.concatenate([pairs, found])
        contacts = _Contacts(vertices[surface.triangles], moving[surface.triangles[:, 0]], pairs, gap, depth)
        parting = contacts.least_translation(allowed)
        if parting is None:
            return None
        shift = parting
    return None


class _Contacts:
    """Pairs of a moving triangle and another one that touch."""

    def __init__(self, corners: Floats, moving: _Flags, pairs: Indices, gap: float, depth: float) -> None:
        """corners: of all triangles, (F, 3, 3). moving: flags of triangles, (F,). pairs: of triangles, (k, 2)."""
        is_first = moving[pairs[:, :1]]
        ours, others = (np.where(is_first == side, pairs[:, :1], pairs[:, 1:]).ravel() for side in (True, False))
        self._moving, self._others = corners[ours], corners[others]
        self._tolerance = max(depth, _tolerance(self._moving, self._others))
        self._gap = gap
        self._toward_body = corners[moving].mean(axis=(0, 1)) - self._moving.mean(axis=(0, 1))

    def least_translation(self, allowed: Floats) -> Floats | None:
        """The least translation found that parts all pairs; None without one. allowed: projection, (3, 3)."""
        if not are_touching(self._moving, self._others, self._tolerance):
            return None
        step = -(-len(self._moving) // _SAMPLE)
        a, b = self._moving[::step], self._others[::step]
        axes = self._separating(a, b)
        needed = _beyond(axes, a, b) + self._gap  # of a translation along each axis, for each pair
        parts = needed <= self._tolerance + self._gap
        ranks, chosen, shift = self._ranks(axes, a, b), list[int](), np.zeros(3)
        while True:
            left = (needed > axes @ shift + SAME * self._gap).all(axis=1)
            if not left.any():
                return shift
            counts = np.count_nonzero(parts[left], axis=0)
            best = max(range(len(axes)), key=lambda axis: (counts[axis], *ranks[axis]), default=0)
            if len(axes) == 0 or counts[best] == 0 or len(chosen) == _MOST_CHOSEN:
                return None
            chosen.append(best)
            heights = np.array([needed[parts[:, axis], axis].max() for axis in chosen])
            least = _least_beyond(axes[chosen] @ allowed, heights)
            if least is None or np.linalg.norm(least) > _LONGEST * (self._tolerance + self._gap):
                return None
            shift = least

    def _separating(self, a: Floats, b: Floats) -> Floats:
        """The directions, (m, 3), along which a pair is parted by a motion of the size of rounding."""
        axes = axes_of(a, b)
        both = np.concatenate([axes, -axes], axis=1)
        found = both[overlaps_along(axes, a, b) <= self._tolerance]
        _, first, counts = np.unique(np.round(found / SAME) + 0.0, axis=0, return_index=True, return_counts=True)
        often = np.argsort(-counts, kind="stable")[:_MOST_AXES]
        directions: Floats = found[first[often]]
        return directions

    def _ranks(self, axes: Floats, a: Floats, b: Floats) -> list[tuple[float, ...]]:
        """Which of two directions is likelier the way out where faces lie in one plane; the greater ones first.

        With the bulk of the moving bodies. Something flat, such as a carpet: with its own front, and away from the
        faces of others. Then upward.
        """
        bulk = axes @ self._toward_body
        fronts = axes @ (_mean_normal(a) + _mean_normal(b))
        side = np.where(np.abs(bulk) > self._tolerance, np.sign(bulk), 0.0)
        return [tuple(row) for row in np.round(np.stack([side, fronts, axes[:, 2]], axis=1), 3).tolist()]


def _tolerance(first: Floats, second: Floats) -> float:
    return DEEPEST * max(rounding_of(first), rounding_of(second))


def axes_of(a: Floats, b: Floats) -> Floats:
    """Unit axes, (k, 17, 3), of which one separates two triangles of a row, (k, 3, 3) each, that do not intersect.

    The normals, their products with the edges for triangles in one plane, and the products of the edges; 0 for those
    that have no length.
    """
    edges = [np.roll(each, -1, axis=1) - each for each in (a, b)]
    normals = [np.cross(each[:, 0], each[:, 1])[:, None] for each in edges]
    sides = [np.cross(each, normal) for each, normal in zip(edges, normals, strict=True)]
    products = np.cross(edges[0][:, :, None], edges[1][:, None, :]).reshape(-1, 9, 3)
    scale = [np.linalg.norm(each, axis=2).max(axis=1) for each in edges]
    lengths = (scale[0] ** 2, scale[1] ** 2, scale[0] ** 3, scale[1] ** 3, scale[0] * scale[1])
    rows = [
        each / np.maximum(length, np.finfo(float).tiny)[:, None, None]
        for each, length in zip((*normals, *sides, products), lengths, strict=True)
    ]
    axes = np.concatenate(rows, axis=1)
    norms = np.linalg.norm(axes, axis=2, keepdims=True)
    return np.where(norms > SAME, axes / np.maximum(norms, SAME), 0.0)


def overlaps_along(axes: Floats, a: Floats, b: Floats) -> Floats:
    """How far each first triangle must move to lie beyond the second, (k, 2 m), along axes, (k, m, 3), and back.

    Infinite for axes without a length.
    """
    first, second = (np.einsum("kmj,kcj->kmc", axes, each) for each in (a, b))
    ahead = second.max(axis=2) - first.min(axis=2)
    back = first.max(axis=2) - second.min(axis=2)
    given = axes.any(axis=2)
    return np.concatenate([np.where(given, each, np.inf) for each in (ahead, back)], axis=1)


def _beyond(axes: Floats, a: Floats, b: Floats) -> Floats:
    """How far each first triangle must move to lie beyond the second, (k, m), along common axes, (m, 3)."""
    return np.asarray((b @ axes.T).max(axis=1) - (a @ axes.T).min(axis=1))


def _least_beyond(normals: Floats, heights: Floats) -> Floats | None:
    """The shortest vector, (3,), that reaches heights, (m,), above 0 along normals, (m, 3); None without one."""
    best: Floats | None = None
    rows = (list(each) for size in (1, 2, 3) for each in combinations(range(len(heights)), size))
    for chosen in rows:
        vector: Floats = np.linalg.lstsq(normals[chosen], heights[chosen], rcond=SAME)[0].astype(np.float64)
        reaches = bool((normals @ vector >= heights * (1 - SAME)).all())
        if reaches and (best is None or np.linalg.norm(vector) < np.linalg.norm(best)):
            best = vector
    return best


def _mean_normal(triangles: Floats) -> Floats:
    """The mean unit normal, (3,), of triangles, (k, 3, 3)."""
    mean: Floats = unit_of(normals_of(triangles)).mean(axis=0)
    return mean


def normals_of(triangles: Floats) -> Floats:
    """Normals of triangles, (k, 3, 3), whose length is twice their area, (k, 3)."""
    return np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])


def unit_of(vectors: Floats) -> Floats:
    """Vectors, (k, 3), of length 1, or 0."""
    unit: Floats = vectors / np.maximum(np.linalg.norm(vectors, axis=1), np.finfo(float).tiny)[:, None]
    return unit
