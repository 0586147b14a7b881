# SPDX-License-Identifier: GPL-3.0-or-later
"""Continuous collision detection along linear steps."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv import _native
from stiv._native import InputError
from stiv.arrays import Floats, Indices, as_choice, as_count, as_floats, as_indices, as_number, as_reals, check_finite
from stiv.surface import Surface, as_surface


@dataclass(frozen=True)
class Events:
    """Interference events as arrays, sorted by kind and vertices.

    For the weights w of an event, sum w = 0, and sum w_k x_k(time) is the vector from the closest point of the second
    side to that of the first.
    """

    kind: NDArray[np.uint8]
    """(K,) 0 for a vertex and a face (vertices v, a, b, c), 1 for two edges (a0, a1, b0, b1)."""
    vertices: Indices
    """(K, 4)"""
    time: Floats
    """(K,) in [0, 1]"""
    weights: Floats
    """(K, 4): (1, -a, -b, -c) or (1-s, s, -(1-u), -u)"""
    normal: Floats
    """(K, 3) contact normals of length 1; normal . (relative displacement) <= 0; zero if undefined"""
    start_distance: Floats
    """(K,) distance of the primitives at the start of the step"""

    def __len__(self) -> int:
        """Return the number of events."""
        return len(self.kind)

    @property
    def kind_names(self) -> NDArray[np.str_]:
        """(K,) "vf" or "ee"."""
        return np.array(list(_native.EventKind.__members__))[self.kind]


def time_of_impact(kind: str, start: ArrayLike, end: ArrayLike, separation: float = 0.0, *, threads: int = 0) -> Floats:
    """Return the time of impact of M pairs of primitives, (M,) float64: in [0, 1], inf without impact.

    kind        "vf": a vertex, then the three of a face; "ee": the two of one edge, then of the other
    start, end  (M, 4, 3): the four vertices before and after a linear motion
    separation  at least 0; impact is where the distance of the primitives first falls to it
    threads     0: one for each processor

    Conservative: never later than the true time, and 0 for a pair that starts within the separation.
    Raises InputError naming the row for wrong shapes, numbers that are not finite, and coordinates that are neither 0
    nor of magnitude 1e-70 to 1e70.
    """
    event_kind = as_choice(kind, "kind", _native.EventKind)
    first = as_floats(start, "start", (None, 4, 3))
    last = as_floats(end, "end", (len(first), 4, 3))
    return _native.times_of_impact(
        event_kind,
        first.reshape(-1, 12),
        last.reshape(-1, 12),
        as_number(separation, "separation", 0),
        as_count(threads, "threads"),
    )


class Detector:
    """Finds interference along steps of one surface. Caches its trees between calls.

    Vertices that rest between calls cost almost nothing, and so does a step from the same start to a nearby end, as in
    the next round of an edit. Events exactly equal those of a new detector.

    surface       Surface, or triangles (F, 3) over as many vertices as the first step has
    broad_phase   "bvh": bounding volume hierarchies; "hash_grid": a uniform grid; "brute_force": all pairs, for tests
    narrow_phase  "conservative": conservative advancement with separating planes, never late; "polynomial": as in the
                  paper, roots of polynomials of degree 3 (6 with a separation) minus 1/100, which misses contacts on
                  edges and corners and in a common plane
    threads       0: one for each processor; results are the same for any number

    Pairs that share a vertex, static pairs and ignored pairs of bodies are not tested. Contiguous float64 arrays are
    read in place, so no other thread may write to them during a call.
    """

    def __init__(
        self,
        surface: Surface | ArrayLike,
        broad_phase: str = "bvh",
        narrow_phase: str = "conservative",
        threads: int = 0,
    ) -> None:
        """Check the arguments. The first step builds the trees."""
        self._broad_phase = as_choice(broad_phase, "broad_phase", _native.BroadPhase)
        self._narrow_phase = as_choice(narrow_phase, "narrow_phase", _native.NarrowPhase)
        self._threads = as_count(threads, "threads")
        self._surface = surface if isinstance(surface, Surface) else as_indices(surface, "triangles", (None, 3))
        self._native: _native.Detector | None = None

    def find(
        self, start: ArrayLike, end: ArrayLike, separation: float = 0.0, min_clearance_ratio: float = 0.5
    ) -> Events:
        """Return all events of the step from `start` to `end`, (N, 3) each.

        A pair interferes when it comes within the separation. A pair that starts nearer than that, at
        distance d0, interferes within min_clearance_ratio d0.
        """
        first, last = self._positions(start, end)
        with _naming_rows(first, last):
            return Events(*self._ready(len(first)).find(first, last, *_proximity(separation, min_clearance_ratio)))

    def earliest_time(
        self, start: ArrayLike, end: ArrayLike, separation: float = 0.0, min_clearance_ratio: float = 0.5
    ) -> float:
        """Return the time of the earliest event, inf if there is none. Faster than `find`."""
        first, last = self._positions(start, end)
        with _naming_rows(first, last):
            return self._ready(len(first)).earliest_time(first, last, *_proximity(separation, min_clearance_ratio))

    def _positions(self, start: ArrayLike, end: ArrayLike) -> tuple[Floats, Floats]:
        rows = self._surface.vertex_count if isinstance(self._surface, Surface) else None
        first = as_reals(start, "start", (rows, 3))
        return first, as_reals(end, "end", (len(first), 3))

    def _ready(self, vertex_count: int) -> _native.Detector:
        if self._native is None:
            self._surface = as_surface(self._surface, vertex_count)
            self._native = _native.Detector(self._surface.native, self._broad_phase, self._narrow_phase, self._threads)
        return self._native


@contextmanager
def _naming_rows(start: Floats, end: Floats) -> Iterator[None]:
    """Adds the name of the array to errors on numbers that are not finite. The core only checks rows that changed since
    the last step, which is faster.
    """
    try:
        yield
    except InputError:
        check_finite(start, "start")
        check_finite(end, "end")
        raise


def _proximity(separation: float, min_clearance_ratio: float) -> tuple[float, float]:
    return as_number(separation, "separation", 0), as_number(min_clearance_ratio, "min_clearance_ratio", 0)


def find_interference(
    triangles: Surface | ArrayLike,
    start: ArrayLike,
    end: ArrayLike,
    separation: float = 0.0,
    broad_phase: str = "bvh",
    narrow_phase: str = "conservative",
    threads: int = 0,
) -> Events:
    """Return all events of one step. For several steps, `Detector` is faster.

    triangles   (F, 3), or a Surface; vertices without a triangle are points
    start, end  (N, 3) positions
    """
    first = as_floats(start, "start", (None, 3))
    surface = as_surface(triangles, len(first))
    return Detector(surface, broad_phase, narrow_phase, threads).find(first, end, separation)
