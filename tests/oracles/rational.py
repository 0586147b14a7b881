# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersections of triangles in rational arithmetic: slow, and correct by construction.

It clips the parameter domain of one triangle by the linear constraints that describe the other, and shares
only the definition with the core. It works for doubles of any size, and for triangles without area. Corners
are scaled to integers by a power of two, so that fractions, many times slower, appear only where polygons are clipped.
"""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

Number = int | Fraction
Vector = tuple[Number, ...]
"""Three coordinates, or two parameters (s, t)."""


class Constraint(NamedTuple):
    """normal . x >= offset"""

    normal: Vector
    offset: Number


def dot(a: Vector, b: Vector) -> Number:
    return sum(x * y for x, y in zip(a, b, strict=True))


def minus(a: Vector, b: Vector) -> Vector:
    return tuple(x - y for x, y in zip(a, b, strict=True))


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def integers(points: Iterable[Iterable[float]]) -> list[Vector]:
    """Points multiplied by the least power of two that makes all coordinates integers."""
    ratios = [[float(x).as_integer_ratio() for x in point] for point in points]
    scale = max(denominator for point in ratios for _, denominator in point)
    return [tuple(numerator * (scale // denominator) for numerator, denominator in point) for point in ratios]


def equal(normal: Vector, point: Vector) -> list[Constraint]:
    offset = dot(normal, point)
    return [Constraint(normal, offset), Constraint(tuple(-x for x in normal), -offset)]


def constraints_of_segment(a: Vector, b: Vector) -> list[Constraint]:
    along = minus(b, a)
    x, y, z = along
    found = [c for normal in ((0, z, -y), (-z, 0, x), (y, -x, 0)) for c in equal(normal, a)]
    return [*found, Constraint(along, dot(along, a)), Constraint(tuple(-c for c in along), -dot(along, b))]


def constraints_of_triangle(corners: Sequence[Vector]) -> list[Constraint]:
    """Constraints of the hull of three points, whatever its dimension."""
    a, b, c = corners
    normal = cross(minus(b, a), minus(c, a))
    if any(normal):
        edges = ((a, b), (b, c), (c, a))
        inward = [(cross(normal, minus(end, start)), start) for start, end in edges]
        return equal(normal, a) + [Constraint(side, dot(side, start)) for side, start in inward]
    longest = max(combinations(corners, 2), key=lambda ends: dot(minus(ends[0], ends[1]), minus(ends[0], ends[1])))
    if longest[0] != longest[1]:
        return constraints_of_segment(*longest)
    axes = [tuple(int(i == j) for i in range(3)) for j in range(3)]
    return [c for axis in axes for c in equal(axis, a)]


def clip(polygon: list[Vector], constraint: Constraint) -> list[Vector]:
    """Return the clipped convex polygon (or segment or point), given by its vertices in order."""
    height = [dot(constraint.normal, point) - constraint.offset for point in polygon]
    left: list[Vector] = []
    for k, point in enumerate(polygon):
        before = k - 1
        if height[k] * height[before] < 0:
            share = Fraction(height[before], height[before] - height[k])
            left.append(tuple(x + share * (y - x) for x, y in zip(polygon[before], point, strict=True)))
        if height[k] >= 0:
            left.append(point)
    return left


def common_points(first: Sequence[Vector], second: Sequence[Vector]) -> list[Vector]:
    """Return points whose hull is the intersection of two triangles."""
    origin, u, v = first[0], minus(first[1], first[0]), minus(first[2], first[0])
    polygon: list[Vector] = [(0, 0), (1, 0), (0, 1)]
    for normal, offset in constraints_of_triangle(second):
        in_parameters = Constraint((dot(normal, u), dot(normal, v)), offset - dot(normal, origin))
        polygon = clip(polygon, in_parameters)
        if not polygon:
            return []
    return [tuple(o + s * x + t * y for o, x, y in zip(origin, u, v, strict=True)) for s, t in polygon]


def in_hull(point: Vector, shared: Sequence[Vector]) -> bool:
    """Tell whether a point belongs to the hull of zero, one or two points."""
    if len(shared) < 2:
        return bool(shared) and point == shared[0]
    return all(dot(normal, point) >= offset for normal, offset in constraints_of_triangle([*shared, shared[0]]))


def triangles_intersect(first: Sequence[int], second: Sequence[int], vertices: ArrayLike) -> bool:
    """Tell whether two triangles have a common point outside the hull of the corners that they share by
    index.

    first, second  corner indices, three each
    vertices       (N, 3)
    """
    q = np.asarray(vertices, np.float64)
    shared = set(map(int, first)) & set(map(int, second))
    if len(shared) == 3:
        return True
    indices = [*map(int, first), *map(int, second)]
    corners = integers(q[indices])
    hull = [corners[indices.index(k)] for k in shared]
    return any(not in_hull(point, hull) for point in common_points(corners[:3], corners[3:]))


def find_intersections(vertices: ArrayLike, triangles: ArrayLike) -> set[tuple[int, int]]:
    """Return all pairs of intersecting triangles; pairs with disjoint boxes are skipped."""
    q, faces = np.asarray(vertices, np.float64), np.asarray(triangles)
    low, high = q[faces].min(axis=1), q[faces].max(axis=1)
    found = set()
    for a in range(len(faces)):
        near = ((low[a + 1 :] <= high[a]) & (high[a + 1 :] >= low[a])).all(axis=1)
        found |= {(a, int(b)) for b in a + 1 + np.flatnonzero(near) if triangles_intersect(faces[a], faces[b], q)}
    return found
