# SPDX-License-Identifier: GPL-3.0-or-later
"""Repair of surfaces that already intersect."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv import _native
from stiv._native import Deformation, InputError
from stiv.arrays import Indices, as_floats, as_number
from stiv.contraction import ContractionOptions, as_caged, as_marks, native_contraction
from stiv.edit_options import EditOptions, native_options
from stiv.edit_session import CancelToken, Progress
from stiv.job import Job
from stiv.surface import Surface
from stiv.welding import Welded, weld

_REFUSALS = {
    "": "",
    "coincident": "triangles coincide with others; weld, move or delete them",
    "held": "some intersecting triangles have no vertex that may move; let them move",
    "not_freed": "no contraction is free of intersections; the best leaves {fewest_pairs} pairs",
    "too_far": "the repaired shape deviates by {deviation:.2%}, more than max_deviation allows",
}
_OUT_OF_TIME = {
    "repaired": "the time limit ended the repair; a longer one may come closer",
    "budget": "the time limit was too short",
}


@dataclass(frozen=True)
class RepairOptions:
    """Options of a repair. The defaults are recommended."""

    contraction: ContractionOptions = field(default_factory=ContractionOptions)
    edit: EditOptions = field(
        default_factory=EditOptions
    )  #: separation, storage, threads; time budget of the whole repair
    moves: ArrayLike | None = None  #: (m,) bool: controls that may move; None: all of deformable bodies
    #: merge coincident vertices first, which gives the result its own surface. Not with a deformation
    weld: bool = False
    good_deviation: float = 0.01  #: a repair within this deviation is accepted at once; otherwise, others are tried
    max_deviation: float = 0.05  #: repairs that deviate more are refused


@dataclass(frozen=True)
class RepairResult:
    """Result of a repair. Only "already_free" and "repaired" are free of intersections, by the exact test."""

    #: "already_free", "repaired", "refused" (`message` is the reason), "cancelled", or "budget" (out of time without a
    #: repair within max_deviation); the last three return the given positions
    status: str
    refusal: str  #: "", "coincident", "held", "not_freed" or "too_far"
    message: str  #: reason of the refusal, or that the time budget ended the repair, as text
    out_of_time: bool  #: the time budget ended the repair: with more time, its result may be closer
    surface: Surface  #: the one given; with `weld` the welded one
    positions: NDArray[np.float64]  #: (N', 3) of that surface; with a deformation the controls, (m, 3)
    vertex_map: Indices  #: (N,) vertex of that surface for each given vertex
    pairs: Indices  #: (K, 2) intersecting triangles at `positions`
    loose_edge_pairs: Indices  #: (K, 2) intersecting loose edges and triangles
    loose_vertex_pairs: Indices  #: (K, 2) loose vertices on triangles
    pairs_before: int  #: number of all pairs before the repair
    fewest_pairs: int  #: number of pairs after the best contraction
    steps: int  #: steps of all contractions
    #: root mean square distance of the best repair from the start, in diagonals of the movable surface
    deviation: float
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
    """Remove intersections of a surface: contract it until there are none, then expand it with collisions.

    surface           Surface, or its triangles (F, 3); only deformable bodies are moved
    positions         (m, 3) controls: the positions of all vertices, if there is no deformation
    deformation       from the controls to the surface; None: every vertex is a control
    cage              Surface of the controls, or its triangles (C, 3), which is contracted; required with a deformation
    cancel, progress  as for EditSession.edit

    The time budget of `options.edit` is that of the whole repair: when it ends, the best repair so far is the result.
    Success requires that the exact test finds nothing. Otherwise the positions stay the same, and the result lists the
    intersections. These contractions are tried in order until one deviates little: each body that all pairs have in
    common, closed bodies first; everything; components shrunk until they are apart, then regions around the
    intersections within them; one component after the other; regions around the intersections.
    """
    welded, given = _native_arguments(surface, positions, options, deformation, cage)
    return _result_of(_native.repair(**given, cancel=cancel, progress=progress), welded)


def start_repair(
    surface: Surface | ArrayLike,
    positions: ArrayLike,
    options: RepairOptions | None = None,
    *,
    deformation: Deformation | None = None,
    cage: Surface | ArrayLike | None = None,
) -> Job[RepairResult]:
    """Start :func:`repair` as a job."""
    welded, given = _native_arguments(surface, positions, options, deformation, cage)
    return Job(_native.start_repair(**given), lambda values: _result_of(values, welded))


def _native_arguments(
    surface: Surface | ArrayLike,
    positions: ArrayLike,
    options: RepairOptions | None,
    deformation: Deformation | None,
    cage: Surface | ArrayLike | None,
) -> tuple[Welded, dict[str, Any]]:
    """Return the welded surface, and the arguments of the core."""
    chosen = options or RepairOptions()
    q = as_floats(positions, "positions", (None, 3))
    given, mesh = as_caged(surface, deformation, cage, len(q))
    if chosen.weld and deformation is not None:
        raise InputError("weld: a deformed surface cannot be welded; weld its cage first")
    whole = weld(given, q) if chosen.weld else Welded(given, q, np.arange(given.vertex_count, dtype=np.int32))
    native = _native.RepairOptions()
    native.contraction = native_contraction(chosen.contraction)
    native.edit = native_options(chosen.edit)
    moves = chosen.moves if deformation is not None else _moves_after(whole, chosen.moves, len(q))
    native.moves = as_marks(moves, len(whole.positions))
    native.good_deviation = as_number(chosen.good_deviation, "good_deviation", 0)
    native.max_deviation = as_number(chosen.max_deviation, "max_deviation", 0)
    return whole, {
        "surface": whole.surface.native,
        "positions": whole.positions,
        "options": native,
        "deformation": deformation,
        "cage": mesh.native,
    }


def _result_of(values: dict[str, Any], welded: Welded) -> RepairResult:
    message = _REFUSALS[values["refusal"]].format(**values)
    if values["out_of_time"]:
        message = _OUT_OF_TIME[values["status"]]
    return RepairResult(message=message, surface=welded.surface, vertex_map=welded.vertex_map, **values)


def _moves_after(welded: Welded, moves: ArrayLike | None, count: int) -> ArrayLike | None:
    """Return the welded vertices that may move: those whose original vertices all may."""
    if moves is None:
        return None
    held = np.bincount(welded.vertex_map, ~np.array(as_marks(moves, count), bool), len(welded.positions))
    free: NDArray[np.bool_] = held == 0
    return free
