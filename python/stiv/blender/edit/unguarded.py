# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits with interference off: the goal itself, as it is stored, tested against nothing."""

from collections.abc import Sequence

import numpy as np

import stiv
from stiv.blender.controls.control_set import Part
from stiv.blender.controls.points import as_single
from stiv.blender.edit.sessions import stacked
from stiv.blender.scene.arrays import Floats, Indices, transform_points

STATUS = "unguarded"


def as_stored(parts: Sequence[Part], controls: Sequence[Floats]) -> Floats:
    """Controls of all parts, each (m, 3), one after the other as they come back from storing."""
    return stacked([_stored(part, rows) for part, rows in zip(parts, controls, strict=True)])


def _stored(part: Part, controls: Floats) -> Floats:
    if part.frame is None:
        return controls
    resting = (controls == part.controls).all(axis=1)[:, None]
    rounded = transform_points(part.frame, as_single(part.frame, controls))
    return np.asarray(np.where(resting, part.controls, rounded), np.float64)


def result_at(deformation: stiv.Deformation, controls: Floats) -> stiv.EditResult:
    """The account of an edit that went to these controls, (m, 3), whatever is in the way: status "unguarded"."""
    none = np.empty(0)
    nothing = stiv.Events(
        none.astype(np.uint8), _rows(4).astype(np.int32), none, _rows(4), _rows(3), none
    )  # fmt: skip
    return stiv.EditResult(
        status=STATUS, controls=controls, surface=deformation.surface(controls), energy=0.0, fraction=1.0, rounds=0,
        events=nothing, patches=0, blocking=(), timings={"total": 0.0}, counters={"rounds": 0}, path=[controls],
    )  # fmt: skip


def _rows(width: int) -> Floats:
    return np.empty((0, width))


def objects_that_meet(pairs: Indices, surface: stiv.Surface) -> str:
    """Names of the objects in pairs of triangles, (k, 2), of a surface; "surfaces" for those without a face."""
    vertices = surface.triangles[np.unique(pairs)][:, 0]
    names = {surface.bodies[int(body)].name for body in np.unique(np.asarray(surface.vertex_body)[vertices])}
    return "objects " + ", ".join(f'"{name}"' for name in sorted(names)) if names else "surfaces"
