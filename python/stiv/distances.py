# SPDX-License-Identifier: GPL-3.0-or-later
"""How near surfaces are to each other, at rest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from stiv import _native
from stiv.arrays import Floats, as_floats
from stiv.surface import Surface, as_surface


@dataclass(frozen=True)
class LeastDistance:
    """Where two triangles of a surface are nearest to each other."""

    distance: float  #: 0 where they intersect
    triangles: tuple[int, int]  #: smaller index first
    bodies: tuple[str, str]  #: names of the bodies that they belong to
    points: Floats  #: (2, 3) on each of them; where they intersect, the nearest points of their borders


def least_distance(vertices: ArrayLike, surface: Surface | ArrayLike, *, within: bool = False) -> LeastDistance | None:
    """Return the least distance between triangles of different bodies at ``vertices``, (N, 3); None without a pair.

    surface  triangles, (F, 3), or a Surface; pairs of bodies that do not meet are left out
    within   also pairs of one body, but those that share a vertex

    Raises InputError naming the row: a coordinate that is not finite, an index out of range, a wrong shape or dtype.
    """
    q = as_floats(vertices, "vertices", (None, 3))
    whole = as_surface(surface, len(q))
    return least_distance_of(_native.least_distance(whole.native, q, within), whole)


def least_distance_of(values: tuple[Any, ...] | None, surface: Surface) -> LeastDistance | None:
    """Return what the core found, with names."""
    if values is None:
        return None
    distance, (first, second), points = values
    names = [surface.bodies[surface.vertex_body[surface.triangles[k, 0]]].name for k in (first, second)]
    return LeastDistance(distance, (first, second), (names[0], names[1]), np.asarray(points))
