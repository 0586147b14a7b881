# SPDX-License-Identifier: GPL-3.0-or-later
"""The least distance between the bodies of a surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from stiv import _native
from stiv.arrays import Floats, as_floats
from stiv.obstacles import Obstacle
from stiv.surface import Surface, as_surface


@dataclass(frozen=True)
class LeastDistance:
    """The closest points of two triangles of a surface."""

    distance: float  #: 0 if they intersect
    triangles: tuple[int, int]  #: smaller index first
    bodies: tuple[str, str]  #: names of their bodies
    points: Floats  #: (2, 3) the closest point of each; of their boundaries if they intersect


def least_distance(
    vertices: ArrayLike, surface: Surface | ArrayLike, *, within: bool = False, obstacles: Sequence[Obstacle] = ()
) -> LeastDistance | None:
    """Return the least distance between triangles of different bodies at ``vertices``, (N, 3); None without a pair.

    surface    triangles, (F, 3), or a Surface, without its ignored pairs of bodies
    within     also test pairs within a body that share no vertex
    obstacles  bodies beside the surface; only their triangles near it are read, and numbered after those of the surface

    Raises InputError naming the row: a coordinate that is not finite, an index out of range, a wrong shape or dtype.
    """
    q = as_floats(vertices, "vertices", (None, 3))
    whole = as_surface(surface, len(q))
    values = _native.least_distance(whole.native, q, within, [each.native for each in obstacles])
    return least_distance_of(values, whole, obstacles)


def least_distance_of(
    values: tuple[Any, ...] | None, surface: Surface, obstacles: Sequence[Obstacle] = ()
) -> LeastDistance | None:
    """Return the result of the core, with names."""
    if values is None:
        return None
    distance, (first, second), points = values
    names = [_body_of(triangle, surface, obstacles) for triangle in (first, second)]
    return LeastDistance(distance, (first, second), (names[0], names[1]), np.asarray(points))


def _body_of(triangle: int, surface: Surface, obstacles: Sequence[Obstacle]) -> str:
    if triangle < len(surface.triangles):
        body: int = surface.vertex_body[surface.triangles[triangle, 0]]
        return surface.bodies[body].name
    ends = len(surface.triangles) + np.cumsum([each.triangle_count for each in obstacles])
    return obstacles[int(np.searchsorted(ends, triangle, side="right"))].name
