# SPDX-License-Identifier: GPL-3.0-or-later
"""Repair of surfaces that already intersect."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv import _native
from stiv._native import Deformation, InputError
from stiv.arrays import Indices, as_floats, as_number
from stiv.contraction import ContractionOptions, as_caged, as_marks, native_contraction
from stiv.edit_options import EditOptions, native_options
from stiv.edit_session import CancelToken, Progress
from stiv.surface import Surface
from stiv.welding import Welded, weld

_REFUSALS = {
    "": "",
    "coincident": "triangles lie exactly on others, so that neither is inside the other; weld, move or delete them",
    "held": "some that intersect have no vertex that may move",
    "not_freed": "no contraction, of all or of parts, is free of intersections; {fewest_pairs} pairs were left at best",
    "too_far": "what is free of intersections deviates by {deviation:.2%} of the size, more than max_deviation",
}


@dataclass(frozen=True)
class RepairOptions:
    """How a surface is repaired. Every default is the one recommended."""

    contraction: ContractionOptions = field(default_factory=ContractionOptions)
    edit: EditOptions = field(default_factory=EditOptions)  #: separation, storage, threads; time budget of the whole
    moves: ArrayLike | None = None  #: (m,) of bool: what may move; None: everything of deformable bodies
    #: make coincident vertices one first; the result then has a surface of its own. Not with a deformation
    weld: bool = False
    good_deviation: float = 0.01  #: what deviates no more is taken at once, else other ways are tried as well
    max_deviation: float = 0.05  #: what deviates more is refused


@dataclass(frozen=True)
class RepairResult:
    """What a repair came to. Only "already_free" and "repaired" are free of intersections, by the exact test."""

    #: "already_free", "repaired", "refused" (`message` says why), "cancelled", or "budget" (the time was used up before
    #: a repair was found); in the last three cases the positions are those given
    status: str
    refusal: str  #: "", "coincident", "held", "not_freed" or "too_far"
    message: str  #: the refusal in words
    surface: Surface  #: the one given; with `weld` the welded one
    positions: NDArray[np.float64]  #: (N', 3) of that surface; with a deformation the controls, (m, 3)
    vertex_map: Indices  #: (N,) vertex of that surface for each one given
    pairs: Indices  #: (K, 2) triangles that intersect at `positions`
    loose_edge_pairs: Indices  #: (K, 2) loose edges and triangles that they meet
    loose_vertex_pairs: Indices  #: (K, 2) vertices without edges and triangles that they lie on
    pairs_before: int  #: number of all pairs before the repair
    fewest_pairs: int  #: number of pairs that the best contraction left
    steps: int  #: steps of contraction, of all tries
    deviation: float  #: root mean square distance of the best repair from the start, in diagonals of what may move
    contracted: str  #: what was contracted: the name of a body, "all", "shrunk components", "components" or "regions"
    counters: dict[str, int]
    timings: dict[str, float]


def repair(
    surface: Surface | ArrayLike,
    positions: ArrayLike,
    options: RepairOptions | None = None,
    *,
    deformation: Deformation | None = None,
    cage: Surface | ArrayLike | None = None,
    cancel: CancelToken | None = None,
    progress: Progress | None = None,
) -> RepairResult:
    """Remove intersections that a surface already has: contract it until there are none, expand it with interference.

    surface           Surface, or its triangles (F, 3); only deformable bodies are moved
    positions         (m, 3) controls: the positions of all vertices, if there is no deformation
    deformation       from the controls to the surface; None: every vertex is a control
    cage              Surface of the controls, or its triangles (C, 3): what is contracted; needed with a deformation
    cancel, progress  as for EditSession.edit

    Success is claimed only where the exact test says so; otherwise the positions stay as they were, and what intersects
    is listed. Tried in this order until one deviates little: each body that all pairs have in common, closed ones
    first; all that takes part; connected components shrunk until they are apart, then the parts around what intersects
    within them; components contracted one after the other; the parts around what intersects.
    """
    chosen = options or RepairOptions()
    q = as_floats(positions, "positions", (None, 3))
    given, mesh = as_caged(surface, deformation, cage, len(q))
    if chosen.weld and deformation is not None:
        raise InputError("weld: what a deformation moves cannot be welded; weld its cage before")
    whole = weld(given, q) if chosen.weld else Welded(given, q, np.arange(given.vertex_count, dtype=np.int32))
    native = _native.RepairOptions()
    native.contraction = native_contraction(chosen.contraction)
    native.edit = native_options(chosen.edit)
    moves = chosen.moves if deformation is not None else _moves_after(whole, chosen.moves, len(q))
    native.moves = as_marks(moves, len(whole.positions))
    native.good_deviation = as_number(chosen.good_deviation, "good_deviation", 0)
    native.max_deviation = as_number(chosen.max_deviation, "max_deviation", 0)
    values = _native.repair(whole.surface.native, whole.positions, native, deformation, mesh.native, cancel, progress)
    message = _REFUSALS[values["refusal"]].format(**values)
    return RepairResult(message=message, surface=whole.surface, vertex_map=whole.vertex_map, **values)


def _moves_after(welded: Welded, moves: ArrayLike | None, count: int) -> ArrayLike | None:
    """What may move of the welded surface: vertices of which all that they were made of may."""
    if moves is None:
        return None
    held = np.bincount(welded.vertex_map, ~np.array(as_marks(moves, count), bool), len(welded.positions))
    free: NDArray[np.bool_] = held == 0
    return free
