# SPDX-License-Identifier: GPL-3.0-or-later
"""Contraction of a surface toward its skeleton, and expansion with collisions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv import _native
from stiv._native import Deformation, InputError
from stiv.arrays import Floats, as_count, as_floats, as_number
from stiv.edit_options import EditOptions, StorageFrame, native_options
from stiv.edit_session import CancelToken, EditResult, Progress, result_of
from stiv.job import Job
from stiv.surface import Surface, as_surface


@dataclass(frozen=True)
class ContractionOptions:
    """Options of a contraction. The defaults are recommended."""

    smoothing: float = 1.0  #: weight w of the first step, independent of the size of the shape
    growth: float = 2.0  #: factor of w from step to step, above 1
    max_steps: int = 16
    tolerance: float = 2.0  #: stops when the pairs exceed this multiple of their minimum, at least 1
    time_budget: float = 0.0  #: seconds, then the best step so far is the result; 0: no limit, as within a repair


@dataclass(frozen=True)
class ContractionResult:
    """Result of a contraction."""

    positions: NDArray[np.float64]  #: (m, 3) after the step with the fewest pairs; the start if no step reduced them
    free: bool  #: whether the surface there is free of intersections
    pairs: list[int]  #: number of intersecting pairs at the start and after each step
    out_of_time: bool = False  #: the time budget ended the contraction


def contraction_step(
    surface: Surface | ArrayLike,
    positions: ArrayLike,
    *,
    start: ArrayLike | None = None,
    smoothing: float = 1.0,
    moves: ArrayLike | None = None,
) -> Floats:
    """Return `positions` after one step of contraction toward the skeleton, (N, 3).

    surface    Surface, or its triangles (F, 3)
    positions  (N, 3)
    start      (N, 3) shape before the contraction, which determines weights and areas; None: `positions`
    smoothing  w, the strength of the step, above 0 and independent of size; double it from step to step
    moves      (N,) bool: vertices that may move; None: all

    Constrained Laplacian smoothing [Au et al., Skeleton extraction by mesh contraction, 2008]. It shrinks along the
    normals, thin parts first, and attracts shrunk parts to their position. Intersections may appear and disappear.
    """
    return _native.contraction_step(**_step_arguments(surface, positions, start, smoothing, moves))


def start_contraction_step(
    surface: Surface | ArrayLike,
    positions: ArrayLike,
    *,
    start: ArrayLike | None = None,
    smoothing: float = 1.0,
    moves: ArrayLike | None = None,
) -> Job[Floats]:
    """Start :func:`contraction_step` as a job. It can only be cancelled before it begins."""
    given = _step_arguments(surface, positions, start, smoothing, moves)
    return Job(_native.start_contraction_step(**given), np.asarray)


def _step_arguments(
    surface: Surface | ArrayLike,
    positions: ArrayLike,
    start: ArrayLike | None,
    smoothing: float,
    moves: ArrayLike | None,
) -> dict[str, Any]:
    """Return the arguments of the core."""
    q = as_floats(positions, "positions", (None, 3))
    whole = as_surface(surface, len(q))
    first = q if start is None else as_floats(start, "start", (len(q), 3))
    strength = as_number(smoothing, "smoothing", 0)
    if strength == 0:
        raise InputError("smoothing must be above 0")
    marks = as_marks(moves, len(q))
    return {"surface": whole.native, "start": first, "positions": q, "moves": marks, "smoothing": strength}


def contract(
    surface: Surface | ArrayLike,
    positions: ArrayLike,
    options: ContractionOptions | None = None,
    *,
    deformation: Deformation | None = None,
    cage: Surface | ArrayLike | None = None,
    moves: ArrayLike | None = None,
    single_precision: bool = True,
    storage: Sequence[StorageFrame] = (),
    threads: int = 0,
    cancel: CancelToken | None = None,
    progress: Progress | None = None,
) -> ContractionResult:
    """Contract until the exact test finds no intersections, or until they increase.

    surface           Surface, or its triangles (F, 3)
    positions         (m, 3) controls: the positions of all vertices, if there is no deformation
    deformation       from the controls to the surface; None: every vertex is a control
    cage              Surface of the controls, or its triangles (C, 3), which is smoothed; required with a deformation
    moves             (m,) bool: controls that may move; None: all
    single_precision  whether controls are rounded to float32 before they are tested
    storage           frames of stored controls, as in EditOptions; empty: world coordinates for all
    cancel, progress  as for EditSession.edit; a cancelled contraction returns the start, without counts of pairs
    """
    given = _contraction_arguments(
        surface, positions, options, deformation, cage, moves, single_precision, storage, threads
    )
    return ContractionResult(**_native.contract(**given, cancel=cancel, progress=progress))


def start_contract(
    surface: Surface | ArrayLike,
    positions: ArrayLike,
    options: ContractionOptions | None = None,
    *,
    deformation: Deformation | None = None,
    cage: Surface | ArrayLike | None = None,
    moves: ArrayLike | None = None,
    single_precision: bool = True,
    storage: Sequence[StorageFrame] = (),
    threads: int = 0,
) -> Job[ContractionResult]:
    """Start :func:`contract` as a job."""
    given = _contraction_arguments(
        surface, positions, options, deformation, cage, moves, single_precision, storage, threads
    )
    return Job(_native.start_contraction(**given), lambda values: ContractionResult(**values))


def _contraction_arguments(
    surface: Surface | ArrayLike,
    positions: ArrayLike,
    options: ContractionOptions | None,
    deformation: Deformation | None,
    cage: Surface | ArrayLike | None,
    moves: ArrayLike | None,
    single_precision: bool,
    storage: Sequence[StorageFrame],
    threads: int,
) -> dict[str, Any]:
    """Return the arguments of the core."""
    p = as_floats(positions, "positions", (None, 3))
    whole, mesh = as_caged(surface, deformation, cage, len(p))
    native = native_contraction(options or ContractionOptions())
    frames = [_native.StorageFrame(each.first, each.count, np.asarray(each.frame, float)) for each in storage]
    native.storage = (frames or [_native.StorageFrame(0, len(p), np.eye(4))]) if single_precision else []
    return {
        "surface": whole.native,
        "positions": p,
        "moves": as_marks(moves, len(p)),
        "options": native,
        "threads": as_count(threads, "threads"),
        "deformation": deformation,
        "cage": mesh.native,
    }


def expand(
    surface: Surface | ArrayLike,
    positions: ArrayLike,
    target: ArrayLike,
    options: EditOptions | None = None,
    *,
    deformation: Deformation | None = None,
    cancel: CancelToken | None = None,
    progress: Progress | None = None,
) -> EditResult:
    """Move a surface free of intersections toward any `target` with the same vertices, with collisions.

    surface            Surface, or its triangles (F, 3)
    positions, target  (m, 3) controls each: the positions of all vertices, if there is no deformation
    deformation        from the controls to the surface; None: every vertex is a control
    cancel, progress   as for EditSession.edit

    One edit, then settling; used to undo a contraction. Raises StartIntersectsError if `positions` intersect.
    """
    whole, given = _expansion_arguments(surface, positions, target, options, deformation)
    return result_of(_native.expand(**given, cancel=cancel, progress=progress), whole)


def start_expand(
    surface: Surface | ArrayLike,
    positions: ArrayLike,
    target: ArrayLike,
    options: EditOptions | None = None,
    *,
    deformation: Deformation | None = None,
) -> Job[EditResult]:
    """Start :func:`expand` as a job."""
    whole, given = _expansion_arguments(surface, positions, target, options, deformation)
    return Job(_native.start_expansion(**given), lambda values: result_of(values, whole))


def _expansion_arguments(
    surface: Surface | ArrayLike,
    positions: ArrayLike,
    target: ArrayLike,
    options: EditOptions | None,
    deformation: Deformation | None,
) -> tuple[Surface, dict[str, Any]]:
    """Return the surface, and the arguments of the core."""
    p = as_floats(positions, "positions", (None, 3))
    whole = as_surface(surface, len(p) if deformation is None else deformation.vertex_count)
    goal = as_floats(target, "target", (len(p), 3))
    native = native_options(options or EditOptions())
    given = {"surface": whole.native, "positions": p, "target": goal, "options": native, "deformation": deformation}
    return whole, given


def as_caged(
    surface: Surface | ArrayLike, deformation: Deformation | None, cage: Surface | ArrayLike | None, controls: int
) -> tuple[Surface, Surface]:
    """Return the surface and the mesh of its controls, which is the surface itself without a deformation."""
    if deformation is None:
        if cage is not None:
            raise InputError("cage: there is no deformation; leave out the cage")
        whole = as_surface(surface, controls)
        return whole, whole
    if cage is None:
        raise InputError("cage: a deformation needs the triangles of its controls")
    return as_surface(surface, deformation.vertex_count), as_surface(cage, controls)


def as_marks(moves: ArrayLike | None, count: int) -> list[int]:
    """Return `moves`, (count,) bool, in the form of the core."""
    if moves is None:
        return []
    marks = np.asarray(moves)
    if marks.dtype != bool or marks.shape != (count,):
        raise InputError(f"moves: expected ({count},) bool, not {marks.shape} {marks.dtype}")
    result: list[int] = marks.astype(int).tolist()
    return result


def native_contraction(options: ContractionOptions) -> Any:
    """Return the options in the form of the core."""
    native = _native.ContractionOptions()
    for option in fields(options):
        value = getattr(options, option.name)
        try:
            setattr(native, option.name, value)
        except TypeError as error:
            raise InputError(f"{option.name}: {value!r} is of the wrong type") from error
    return native
