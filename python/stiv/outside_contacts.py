# SPDX-License-Identifier: GPL-3.0-or-later
"""Tells contacts of surfaces beside each other, which only touch, from those of surfaces that lie in each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stiv.arrays import Floats, Indices
from stiv.intersections import IntersectionTest
from stiv.surface import Body, Surface
from stiv.touching import (
    DEEPEST,
    DEEPEST_LEFT,
    SAME,
    axes_of,
    depths_of,
    find_parting,
    normals_of,
    overlaps_along,
    unit_of,
)

_Flags = NDArray[np.bool_]

_SHRUNK = 8  # depths, of the least extent
_LEAST_EXTENT = 1000  # depths; bodies shrink by less than a hundredth
_ALIKE = 0.9999  # cosine of the angle of normals that face the same way


def touching_from_outside(first: Floats, second: Floats, group: Indices) -> _Flags:
    """Return which groups of rows, (g,), are contacts of two surfaces beside each other.

    first, second  triangles, (k, 3, 3) each, that intersect those of the same row
    group          (k,) numbers from 0, each once at least, of two surfaces that meet in these rows

    No triangle of these groups cuts deeper than rounding, and none covers a part of one in its plane that faces the
    same way. A plane separates the surfaces there, or a translation or shrinking of the size of rounding parts them. So
    they do not cross each other along edges.
    """
    depths = _touching_depths(first, second, group)
    is_deep = (depths_of(first, second) > depths[group]) | _cover(first, second, depths[group])
    touching: _Flags = np.bincount(group[is_deep], minlength=len(depths)) == 0
    for number in np.flatnonzero(touching & ~_lie_on_each_other(first, second, group, depths)).tolist():
        own = group == number
        a, b = (np.unique(each[own].reshape(-1, 9), axis=0).reshape(-1, 3, 3) for each in (first, second))
        touching[number] = _are_beside(a, b, depths[number]) or _can_part(a, b, depths[number])
    return touching


def _touching_depths(first: Floats, second: Floats, group: Indices) -> Floats:
    """The depth of touching surfaces, for each group: that of rounding, or the one that edits leave."""
    sizes = np.zeros((2, int(group.max(initial=-1)) + 1), np.float32)
    for side, each in enumerate((first, second)):
        np.maximum.at(sizes[side], group, np.abs(each).max(axis=(1, 2)).astype(np.float32))
    roundings = np.spacing(sizes).astype(np.float64)
    depths: Floats = np.maximum(DEEPEST * roundings.max(axis=0), DEEPEST_LEFT * roundings.min(axis=0))
    return depths


def _lie_on_each_other(first: Floats, second: Floats, group: Indices, depths: Floats) -> _Flags:
    """Flags the groups in which the plane of two triangles that face each other separates all, but for the depth.

    Faster than `_are_beside` for each group. depths: of each group.
    """
    normals = [normals_of(each) for each in (first, second)]
    areas = np.linalg.norm(normals, axis=2).min(axis=0)
    facing = np.flatnonzero(np.einsum("kj,kj->k", *map(unit_of, normals)) < -_ALIKE)
    facing = facing[np.argsort(areas[facing], kind="stable")]
    count = len(depths)
    best = np.full(count, -1)
    best[group[facing]] = facing  # the last of equal groups remains: the largest
    axes = np.where((best >= 0)[:, None], unit_of(normals[0])[best], 0.0)[group]
    heights = [np.einsum("kcj,kj->kc", each, axes) for each in (first, second)]
    low, high = np.full((2, count), np.inf), np.full((2, count), -np.inf)
    for side, each in enumerate(heights):
        np.minimum.at(low[side], group, each.min(axis=1))
        np.maximum.at(high[side], group, each.max(axis=1))
    overlaps = np.minimum(high[0] - low[1], high[1] - low[0])
    separated: _Flags = (best >= 0) & (overlaps <= depths)
    return separated


def _are_beside(first: Floats, second: Floats, depth: float) -> bool:
    """Does a plane of one of the triangles, (n, 3, 3) and (m, 3, 3), separate them, but for the depth?"""
    normals = np.concatenate([normals_of(first), normals_of(second)])
    normals = normals[np.argsort(-np.linalg.norm(normals, axis=1), kind="stable")]  # those of large ones are exact
    axes = unit_of(normals)
    axes = axes[np.unique(np.round(axes / SAME), axis=0, return_index=True)[1]]
    a, b = (each.reshape(-1, 3) @ axes.T for each in (first, second))
    overlaps = np.minimum(a.max(axis=0) - b.min(axis=0), b.max(axis=0) - a.min(axis=0))
    return bool((overlaps[axes.any(axis=1)] <= depth).any())


def _can_part(first: Floats, second: Floats, depth: float) -> bool:
    """Does a translation, or a shrinking, of the size of the depth part two sets of triangles, (n, 3, 3) and (m, 3, 3)?

    Triangles between two walls can only shrink.
    """
    corners = np.concatenate([first, second]).reshape(-1, 3)
    triangles = np.arange(len(corners), dtype=np.int32).reshape(-1, 3)
    moves = np.arange(len(corners)) < 3 * len(first)
    bodies = [Body("second", "fixed"), Body("first", "rigid")]
    surface = Surface(triangles, len(corners), vertex_body=moves.astype(np.int32), bodies=bodies)
    if find_parting(surface, corners, moves, depth, depth=depth) is not None:
        return True
    test, shrunk = IntersectionTest(surface), (_shrunk(corners, rows, depth) for rows in (moves, ~moves))
    return any(each is not None and len(test.find(each)) == 0 for each in shrunk)


def _shrunk(corners: Floats, rows: _Flags, depth: float) -> Floats | None:
    """Corners, (n, 3), some of which are moved toward their middle, those at the sides by more than the depth; None if
    they are flat.
    """
    own = corners[rows]
    middle, extent = (own.min(axis=0) + own.max(axis=0)) / 2, float(np.ptp(own, axis=0).min())
    if extent < _LEAST_EXTENT * depth:
        return None
    shrunk = corners.copy()
    shrunk[rows] += (middle - own) * (_SHRUNK * depth / extent)
    return shrunk


def _cover(first: Floats, second: Floats, depths: Floats) -> _Flags:
    """Flags the triangles, (k, 3, 3), that face like that of the same row, and cover a part wider than the depth."""
    normals = [unit_of(normals_of(each)) for each in (first, second)]
    covers: _Flags = np.einsum("kj,kj->k", *normals) > _ALIKE
    axes = axes_of(first[covers], second[covers])
    overlaps = np.minimum(*np.split(overlaps_along(axes, first[covers], second[covers]), 2, axis=1))
    is_across = np.abs(np.einsum("kmj,kj->km", axes, normals[0][covers])) > _ALIKE
    covers[covers] = (np.where(is_across, np.inf, overlaps) > depths[covers, None]).all(axis=1)
    return covers
