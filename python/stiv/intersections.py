# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact static test for intersections, and the test of steps for acceptance."""

from numpy.typing import ArrayLike

from stiv import _native
from stiv.arrays import Floats, Indices, as_count, as_floats, as_indices, as_number, as_reals
from stiv.surface import Surface, as_surface


def find_intersections(
    vertices: ArrayLike, triangles: Surface | ArrayLike, *, all_bodies: bool = False, threads: int = 0
) -> Indices:
    """Return all pairs of triangles that intersect, (K, 2) int32: smaller index first, sorted.

    vertices    (N, 3) positions
    triangles   (F, 3) vertex indices, or a Surface
    all_bodies  whether to also test pairs that edits do not: of fixed bodies, ignored pairs, a rigid body with itself
    threads     0: one for each processor; the result is the same for any number

    Two triangles intersect if they have a point in common apart from the vertex or edge that they share by index. This
    includes contact, coplanar overlap, duplicates, neighbors that are folded flat, and coincident vertices of different
    index (unless `join_seams` merges them). Triangles without area are segments or points. The result is exact.

    Raises InputError naming the row: a coordinate that is not finite, or that is neither 0 nor of magnitude 1e-70 to
    1e70, an index out of range, a wrong shape or dtype.
    """
    surface, q = _prepared(vertices, triangles, all_bodies)
    return _native.find_intersections(surface.native, q, as_count(threads, "threads"))


def intersection_depths(vertices: ArrayLike, triangles: Surface | ArrayLike, pairs: ArrayLike) -> Floats:
    """Return a bound of the depth to which each pair of triangles intersects, (K,), in the units of the vertices.

    vertices    (N, 3) positions
    triangles   (F, 3) vertex indices, or a Surface
    pairs       (K, 2) int32, of find_intersections

    The depth is the shortest motion that parts the two along one of their separating axes: rounding for triangles that
    only touch, 0 for those that are apart. Corners that they share do not count as an intersection.

    Raises InputError as find_intersections does, and for pairs out of range.
    """
    surface, q = _prepared(vertices, triangles, all_bodies=False)
    return _native.intersection_depths(
        surface.native, as_indices(pairs, "pairs", (None, 2), len(surface.triangles)).tolist(), q
    )


class IntersectionTest:
    """The test of `find_intersections` for many states of one surface. Caches its trees.

    surface  Surface
    threads  0: one for each processor; results are the same for any number
    """

    def __init__(self, surface: Surface, threads: int = 0) -> None:
        """Store the surface. The first positions build the trees; later ones refit them."""
        self._vertex_count = surface.vertex_count
        self._native = _native.IntersectionTest(surface.native, as_count(threads, "threads"))

    def find(self, vertices: ArrayLike) -> Indices:
        """Return all pairs of triangles that intersect at `vertices`, (N, 3); see find_intersections."""
        return self._native.find(as_floats(vertices, "vertices", (self._vertex_count, 3)))


def find_loose_intersections(
    vertices: ArrayLike, surface: Surface, *, all_bodies: bool = False, distance: float = 0.0, threads: int = 0
) -> tuple[Indices, Indices]:
    """Return intersections of loose elements: pairs (loose edge, triangle) and (loose vertex, triangle).

    Each is (K, 2) int32, sorted. A loose vertex belongs to no triangle and no loose edge. Pairs that are nearer than
    `distance` beside their common vertices count too, up to rounding; it is at least 0, in the units of the vertices.
    Other arguments, exactness and errors are those of find_intersections.
    """
    whole, q = _prepared(vertices, surface, all_bodies)
    least = as_number(distance, "distance", 0.0)
    return _native.find_loose_intersections(whole.native, q, least, as_count(threads, "threads"))


def is_step_free(
    triangles: Surface | ArrayLike, start: ArrayLike, end: ArrayLike, separation: float = 0.0, *, threads: int = 0
) -> bool:
    """Return whether the linear step from `start` to `end` is free, at its start, along its path and at its end.

    triangles   (F, 3) vertex indices, or a Surface
    start, end  (N, 3) positions
    separation  minimum distance, at least 0, in the units of the positions; for pairs that start closer, half their
                distance
    threads     0: one for each processor

    The test of start and end is exact, including loose edges and vertices. The test of the path is conservative: True
    is certain, and False may also mean a near contact within the rounding error.

    Raises InputError as find_intersections does.
    """
    first = as_floats(start, "start", (None, 3))
    surface = as_surface(triangles, len(first))
    last = as_floats(end, "end", (len(first), 3))
    distance = as_number(separation, "separation", 0)
    return _native.is_step_free(surface.native, first, last, distance, as_count(threads, "threads"))


class DeviationTest:
    """The exact test of surfaces that deviate by rounding from one without intersections.

    Made by `EditSession.deviation_test`. Immutable: it may be used while the session solves on.
    """

    def __init__(self, native: _native.DeviationTest, threads: int = 0) -> None:
        """Take the test of the core; threads 0 uses all cores."""
        self._native, self._threads = native, as_count(threads, "threads")

    @property
    def reach(self) -> float:
        """The largest deviation of a coordinate that it can decide."""
        return self._native.reach

    def is_free(self, vertices: ArrayLike) -> bool | None:
        """Return whether nothing intersects at `vertices`, (N, 3); None if one of them deviates by more than `reach`.

        The answer is that of `find_intersections`, with loose edges and vertices. Raises InputError as it does.
        """
        return self._native.is_free(as_reals(vertices, "vertices", (None, 3)), self._threads)


class StepCheck:
    """The test of `is_step_free` for many steps of one surface from free starts. Caches its trees.

    surface  Surface
    threads  0: one for each processor; results are the same for any number
    """

    def __init__(self, surface: Surface, threads: int = 0) -> None:
        """Store the surface. The first step builds the trees."""
        self._vertex_count = surface.vertex_count
        self._native = _native.StepCheck(surface.native, as_count(threads, "threads"))

    def is_free(self, start: ArrayLike, end: ArrayLike, separation: float = 0.0) -> bool:
        """Return whether the linear step from `start` to `end`, (N, 3) each, is free, along its path and at its end.

        `start` must be free. Otherwise works like `is_step_free`.
        """
        first = as_floats(start, "start", (self._vertex_count, 3))
        last = as_floats(end, "end", (self._vertex_count, 3))
        return self._native.is_free(first, last, as_number(separation, "separation", 0))

    def is_end_free(self, start: ArrayLike, end: ArrayLike) -> bool:
        """Return whether the end of a step is free; the path to it is not tested.

        Only pairs with a vertex that moves are tested, so `start` must be free.
        """
        first = as_floats(start, "start", (self._vertex_count, 3))
        last = as_floats(end, "end", (self._vertex_count, 3))
        return self._native.is_end_free(first, last)


def _prepared(vertices: ArrayLike, triangles: Surface | ArrayLike, all_bodies: bool) -> tuple[Surface, Floats]:
    q = as_floats(vertices, "vertices", (None, 3))
    surface = as_surface(triangles, len(q))
    if all_bodies:
        surface = Surface(surface.triangles, surface.vertex_count, surface.loose_edges)
    return surface, q
