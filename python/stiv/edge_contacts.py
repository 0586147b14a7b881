# SPDX-License-Identifier: GPL-3.0-or-later
"""T-junctions: triangles that touch only along edges, where a vertex of one lies on an edge of the other.

Uses integers of any size, because only exact coincidence counts: a point is (x, y, z, w) with positive w, in lowest
terms, at (x, y, z) / w in units of the last binary place of a pair of triangles. Filled text has such edges.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stiv.arrays import Floats, Indices

Point = tuple[int, int, int, int]
Vector = tuple[int, int, int]
NEAR = 1e-5  # in sizes of a pair: a vertex further from an edge is not on it
DEEP = 1e-3  # barycentric coordinates above this are inside a triangle despite rounding
SLIVER = 1e-10  # squared areas below this, in sizes of a pair, are too small for barycentric coordinates
INSIDE = np.array([(4, 1, 1), (1, 4, 1), (1, 1, 4), (1, 3, 2), (2, 1, 3), (3, 2, 1)]) / 6

MOST_RESULTS = 64  # one byte for each pair
_results: dict[bytes, NDArray[np.bool_]] = {}  # by digests of corners


def edge_contacts(positions: NDArray[np.floating], triangles: Indices, pairs: Indices) -> NDArray[np.bool_]:
    """Return which intersecting pairs of triangles, (k, 2), only share points of an edge of each, (k,) bool.

    positions  (n, 3) of one mesh
    triangles  (f, 3)

    Edges that cross at a point inside both are not a seam. A triangle without area counts as an edge. The last results
    are stored: copies of a mesh have the same, wherever they are.
    """
    corners = positions[triangles[pairs]].astype(np.float64)  # (k, 2, 3, 3)
    key = hashlib.blake2b(corners.tobytes(), digest_size=32).digest()
    if key not in _results:
        while len(_results) >= MOST_RESULTS:
            del _results[next(iter(_results))]
        _results[key] = _find(corners)
    return _results[key].copy()


def _find(corners: Floats) -> NDArray[np.bool_]:
    """Return which pairs, (k, 2, 3, 3), only share points of an edge of each."""
    found = _vertex_near_edge(corners)
    found[found] = ~_overlap_clearly(corners[found])
    found[found] = ~_edge_passes_through(corners[found])
    for row in np.flatnonzero(found):
        points = _exact_points(corners[row].reshape(6, 3))
        found[row] = _touch_in_edges(points[:3], points[3:])
    return found


def _vertex_near_edge(corners: Floats) -> NDArray[np.bool_]:
    """Return which pairs have a vertex of one near an edge of the other, (k,) bool."""
    near = np.zeros(len(corners), np.bool_)
    size = _sizes(corners)
    for one, other in ((0, 1), (1, 0)):
        for corner in range(3):
            for edge in range(3):
                start, end = corners[:, other, edge], corners[:, other, (edge + 1) % 3]
                along, offset = end - start, corners[:, one, corner] - start
                length = np.maximum((along**2).sum(axis=1), np.finfo(float).tiny)
                fraction = np.clip((offset * along).sum(axis=1) / length, 0, 1)
                near |= np.linalg.norm(offset - fraction[:, None] * along, axis=1) <= NEAR * size
    return near


def _overlap_clearly(corners: Floats) -> NDArray[np.bool_]:
    """Return which pairs clearly overlap, with a point of one well inside the other, (k,) bool."""
    overlap = np.zeros(len(corners), np.bool_)
    for one, other in ((0, 1), (1, 0)):
        a, u, v = (corners[:, other, 0], *(corners[:, other, k] - corners[:, other, 0] for k in (1, 2)))
        normal = np.cross(u, v)
        area = np.maximum((normal**2).sum(axis=1), np.finfo(float).tiny)
        for inside in INSIDE:
            offset = inside @ corners[:, one] - a
            second = (np.cross(offset, v) * normal).sum(axis=1) / area
            third = (np.cross(u, offset) * normal).sum(axis=1) / area
            height = np.abs((offset * normal).sum(axis=1)) / area**0.75
            overlap |= (np.minimum(second, third) > DEEP) & (second + third < 1 - DEEP) & (height < NEAR)
    return overlap


def _edge_passes_through(corners: Floats) -> NDArray[np.bool_]:
    """Return which pairs have an edge of one that clearly passes through the inside of the other, (k,) bool.

    Most pairs that share a vertex and intersect do.
    """
    passes, size = np.zeros(len(corners), np.bool_), _sizes(corners)
    for one, other in ((0, 1), (1, 0)):
        a, u, v = (corners[:, other, 0], *(corners[:, other, k] - corners[:, other, 0] for k in (1, 2)))
        normal = np.cross(u, v)
        area = (normal**2).sum(axis=1)
        is_wide = area > SLIVER * size**4
        area = np.where(is_wide, area, 1.0)
        offsets = corners[:, one] - a[:, None]
        heights = (offsets * normal[:, None]).sum(axis=2) / np.sqrt(area)[:, None]
        for k in range(3):
            below, above = heights[:, k], heights[:, k - 1]
            far = np.minimum(np.abs(below), np.abs(above)) > NEAR * size
            crosses = is_wide & far & ((below > 0) != (above > 0))
            fraction = below / np.where(crosses, below - above, 1.0)
            point = offsets[:, k] + fraction[:, None] * (offsets[:, k - 1] - offsets[:, k])
            second = (np.cross(point, v) * normal).sum(axis=1) / area
            third = (np.cross(u, point) * normal).sum(axis=1) / area
            passes |= crosses & (np.minimum(second, third) > DEEP) & (second + third < 1 - DEEP)
    return passes


def _sizes(corners: Floats) -> Floats:
    """The largest extent of each pair along an axis, (k,)."""
    sizes: Floats = np.ptp(corners.reshape(len(corners), 6, 3), axis=1).max(axis=1, initial=0.0)
    return sizes


def _touch_in_edges(first: Sequence[Point], second: Sequence[Point]) -> bool:
    if not _has_area(second):
        first, second = second, first
    if not _has_area(second):
        return _touch_as_segments(first, second)
    common = _common(first, second)
    if not common or not (_on_edge(common, second) and (_on_edge(common, first) or not _has_area(first))):
        return False
    return any(point != common[0] for point in common) or common[0] in first or common[0] in second


def _touch_as_segments(first: Sequence[Point], second: Sequence[Point]) -> bool:
    """Return whether two intersecting triangles without area overlap in a line, or at an end of one."""
    return any(
        _on_edge([point], other) for one, other in ((first, second), (second, first)) for point in one
    )  # points on the line suffice: distinct lines share one point


def _common(first: Sequence[Point], second: Sequence[Point]) -> list[Point]:
    """Return points whose convex hull is the intersection of two triangles; the second has an area."""
    a, b, c = second
    x, y, z = normal = _cross(_minus(b, a), _minus(c, a))
    polygon = _clipped(_clipped(list(first), normal, a), (-x, -y, -z), a)
    for start, end in ((a, b), (b, c), (c, a)):
        polygon = _clipped(polygon, _cross(normal, _minus(end, start)), start)
    return polygon


def _clipped(polygon: Sequence[Point], normal: Vector, origin: Point) -> list[Point]:
    """Clip a convex polygon to the positive side of a plane. [Sutherland and Hodgman 1974]"""
    heights = [_dot(normal, _minus(point, origin)) for point in polygon]  # each in units of 1 / w
    left: list[Point] = []
    for k, (point, height) in enumerate(zip(polygon, heights, strict=True)):
        before, other = heights[k - 1], polygon[k - 1]
        if height * before < 0:
            left.append(_in_lowest_terms([u * height - v * before for u, v in zip(other, point, strict=True)]))
        if height >= 0:
            left.append(point)
    return left


def _has_area(triangle: Sequence[Point]) -> bool:
    a, b, c = triangle
    return any(_cross(_minus(b, a), _minus(c, a)))


def _on_edge(points: Sequence[Point], triangle: Sequence[Point]) -> bool:
    """Return whether all points are on the line of one edge of a triangle."""
    a, b, c = triangle
    return any(
        start != end and not any(x for point in points for x in _cross(_minus(end, start), _minus(point, start)))
        for start, end in ((a, b), (b, c), (c, a))
    )


def _exact_points(points: Floats) -> list[Point]:
    """Points, (k, 3), in units of their last binary place."""
    ratios = [value.as_integer_ratio() for value in points.ravel().tolist()]
    unit = max(denominator for _, denominator in ratios)  # powers of two
    values = iter([numerator * (unit // denominator) for numerator, denominator in ratios])
    return [(x, y, z, 1) for x, y, z in zip(values, values, values, strict=True)]


def _in_lowest_terms(point: Sequence[int]) -> Point:
    divisor = math.gcd(*point) if point[3] > 0 else -math.gcd(*point)
    x, y, z, w = (value // divisor for value in point)
    return x, y, z, w


def _minus(a: Point, b: Point) -> Vector:
    """A positive multiple of the difference."""
    return a[0] * b[3] - b[0] * a[3], a[1] * b[3] - b[1] * a[3], a[2] * b[3] - b[2] * a[3]


def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _dot(a: Vector, b: Vector) -> int:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
