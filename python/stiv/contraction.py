# SPDX-License-Identifier: GPL-3.0-or-later
"""Contraction of a surface toward its skeleton, and expansion back with interference."""

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
from stiv.surface import Surface, as_surface


@dataclass(frozen=True)
class ContractionOptions:
    """How a contraction goes on. Every default is the one recommended."""

    smoothing: float = 1.0  #: w of the first step, whatever the size of the shape
    growth: float = 2.0  #: factor on w from step to step, above 1
    max_steps: int = 16
    tolerance: float = 2.0  #: stops at so many times the fewest pairs so far, at least 1


@dataclass(frozen=True)
class ContractionResult:
    """What a contraction came to."""

    positions: NDArray[np.float64]  #: (m, 3) of the step that left the fewest pairs; the start if none left fewer
    free: bool  #: nothing intersects there
    pairs: list[int]  #: number of intersecting pairs at the start and after each step


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
    start      (N, 3) shape that the contraction began with, which gives weights and areas; None: `positions`
    smoothing  w: how strong the step is, above 0, the same for any size; double it from step to step
    moves      (N,) of bool: vertices that move; None: all

    Constrained Laplacian smoothing [Au et al., Skeleton extraction by mesh contraction, 2008]: shrinks along the
    normals, thin parts first, while what has shrunk holds on to its place. Intersections may come and go.
    """
    q = as_floats(positions, "positions", (None, 3))
    whole = as_surface(surface, len(q))
    first = q if start is None else as_floats(start, "start", (len(q), 3))
    strength = as_number(smoothing, "smoothing", 0)
    if strength == 0:
        raise InputError("smoothing must be above 0")
    return _native.contraction_step(whole.native, first, q, as_marks(moves, len(q)), strength)


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
    """Contract until the exact test finds nothing that intersects, or until intersections grow.

    surface           Surface, or its triangles (F, 3)
    positions         (m, 3) controls: the positions of all vertices, if there is no deformation
    deformation       from the controls to the surface; None: every vertex is a control
    cage              Surface of the controls, or its triangles (C, 3): what is smoothed; needed with a deformation
    moves             (m,) of bool: controls that move; None: all
    single_precision  controls are rounded as float32 will store them, before they are tested
    storage           frames in which they are stored, as in EditOptions; empty: world coordinates for all
    cancel, progress  as for EditSession.edit; a cancelled contraction gives the start, and no counts of pairs
    """
    p = as_floats(positions, "positions", (None, 3))
    whole, mesh = as_caged(surface, deformation, cage, len(p))
    native = native_contraction(options or ContractionOptions())
    frames = [_native.StorageFrame(each.first, each.count, np.asarray(each.frame, float)) for each in storage]
    native.storage = (frames or [_native.StorageFrame(0, len(p), np.eye(4))]) if single_precision else []
    values = _native.contract(
        whole.native, p, as_marks(moves, len(p)), native, as_count(threads, "threads"), deformation, mesh.native,
        cancel, progress,
    )  # fmt: skip
    return ContractionResult(**values)


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
    """Take a surface free of intersections toward any `target` with the same vertices, with interference on.

    surface            Surface, or its triangles (F, 3)
    positions, target  (m, 3) controls each: the positions of all vertices, if there is no deformation
    deformation        from the controls to the surface; None: every vertex is a control
    cancel, progress   as for EditSession.edit

    One edit, then settling: what a contraction is undone with. Raises StartIntersectsError if `positions` intersect.
    """
    p = as_floats(positions, "positions", (None, 3))
    whole = as_surface(surface, len(p) if deformation is None else deformation.vertex_count)
    goal = as_floats(target, "target", (len(p), 3))
    native = native_options(options or EditOptions())
    return result_of(_native.expand(whole.native, p, goal, native, deformation, cancel, progress), whole)


def as_caged(
    surface: Surface | ArrayLike, deformation: Deformation | None, cage: Surface | ArrayLike | None, controls: int
) -> tuple[Surface, Surface]:
    """Return the surface and the mesh of its controls: the surface itself, if there is no deformation."""
    if deformation is None:
        if cage is not None:
            raise InputError("cage: goes with a deformation, and there is none")
        whole = as_surface(surface, controls)
        return whole, whole
    if cage is None:
        raise InputError("cage: the triangles of the controls are needed with a deformation")
    return as_surface(surface, deformation.vertex_count), as_surface(cage, controls)


def as_marks(moves: ArrayLike | None, count: int) -> list[int]:
    """Return `moves`, (count,) of bool, as the core takes it."""
    if moves is None:
        return []
    marks = np.asarray(moves)
    if marks.dtype != bool or marks.shape != (count,):
        raise InputError(f"moves: expected ({count},) of bool, not {marks.shape} of {marks.dtype}")
    result: list[int] = marks.astype(int).tolist()
    return result


def native_contraction(options: ContractionOptions) -> Any:
    """Return the options as the core takes them."""
    native = _native.ContractionOptions()
    for option in fields(options):
        value = getattr(options, option.name)
        try:
            setattr(native, option.name, value)
        except TypeError as error:
            raise InputError(f"{option.name}: {value!r} is of the wrong type") from error
    return native
