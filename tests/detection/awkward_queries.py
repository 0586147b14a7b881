# SPDX-License-Identifier: GPL-3.0-or-later
"""Random collision queries of kinds that are known to break detectors."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
"""(M, 8, 3): the four vertices at the start, then at the end."""


def general(random: np.random.Generator, count: int) -> Points:
    return random.normal(size=(count, 8, 3))


def grid(random: np.random.Generator, count: int, reach: int = 3) -> Points:
    return random.integers(-reach, reach + 1, (count, 8, 3)).astype(float)


def coarse_grid(random: np.random.Generator, count: int) -> Points:
    return grid(random, count, 1)


def coplanar(random: np.random.Generator, count: int) -> Points:
    return grid(random, count) * [1, 1, 0]


def coplanar_aslant(random: np.random.Generator, count: int) -> Points:
    """Exactly in a plane that is not axis-aligned."""
    flat = grid(random, count)
    return flat @ np.array([[1, 2, 2], [2, -2, 1], [0, 0, 0]], float)


def parallel(random: np.random.Generator, count: int) -> Points:
    """The last two vertices repeat the offset of the first two: parallel edges, or sides of a face along the path."""
    points = grid(random, count)
    factor = random.integers(-2, 3, (count, 1))
    for first in (0, 4):
        points[:, first + 3] = points[:, first + 2] + factor * (points[:, first + 1] - points[:, first])
    return points


def collapsed(random: np.random.Generator, count: int) -> Points:
    """Degenerate faces and edges, at the start, at the end, or always."""
    points = grid(random, count)
    rows = np.arange(count)
    for first in (0, 4):
        a, b = random.integers(0, 4, (2, count))
        some = random.random(count) < 0.7
        points[rows[some], first + a[some]] = points[rows[some], first + b[some]]
    return points


def moved_together(random: np.random.Generator, count: int) -> Points:
    """Nearly the same motion for all four vertices."""
    points = grid(random, count)
    points[:, 4:] = points[:, :4] + random.integers(-9, 10, (count, 1, 3)) + random.integers(-1, 2, (count, 4, 3))
    return points


def grazing(random: np.random.Generator, count: int) -> Points:
    """At half time, a vertex lies on a side or edge of the other primitive, or barely misses it."""
    points = 2 * grid(random, count)
    side = points[:, [2, 3]] + points[:, [6, 7]]
    share = random.integers(0, 5, (count, 1)) / 4
    points[:, 4] = (1 - share) * side[:, 0] + share * side[:, 1] - points[:, 0]
    rows, axis = np.arange(count), random.integers(0, 3, count)
    points[rows, 4, axis] += random.choice([-(2.0**-50), 0.0, 2.0**-50], count)
    return points


def sliver(random: np.random.Generator, count: int) -> Points:
    """The last vertex lies almost on the line through the previous two."""
    points = random.normal(size=(count, 8, 3))
    for first in (0, 4):
        share = random.random((count, 1))
        on_line = (1 - share) * points[:, first + 1] + share * points[:, first + 2]
        points[:, first + 3] = on_line + 2.0**-30 * random.normal(size=(count, 3))
    return points


SORTS: dict[str, Callable[[np.random.Generator, int], Points]] = {
    sort.__name__: sort
    for sort in (
        general,
        grid,
        coarse_grid,
        coplanar,
        coplanar_aslant,
        parallel,
        collapsed,
        moved_together,
        grazing,
        sliver,
    )
}


def make(sort: str, count: int, seed: int) -> Points:
    """`count` queries of one kind."""
    return SORTS[sort](np.random.default_rng(seed), count)
