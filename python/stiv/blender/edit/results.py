# SPDX-License-Identifier: GPL-3.0-or-later
"""Merges results of several calls, and makes those of edits with collisions off."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

import stiv
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.points import to_single
from stiv.blender.edit.sessions import stack_controls
from stiv.blender.scene.arrays import Floats, Indices, transform_points
from stiv.blender.scene.assembly import Assembly


def merge_results(results: Sequence[stiv.EditResult]) -> stiv.EditResult:
    """The last result with the counts of all; the status is the last one other than "unchanged"."""
    last = results[-1]
    changed = [result for result in results if result.status != "unchanged"]
    with_events = [result for result in results if len(result.events)]
    return replace(
        last,
        status=changed[-1].status if changed else last.status,
        fraction=min(result.fraction for result in results),
        rounds=sum(result.rounds for result in results),
        events=with_events[-1].events if with_events else last.events,
        patches=with_events[-1].patches if with_events else last.patches,
        timings={name: sum(result.timings[name] for result in results) for name in last.timings},
        counters={name: sum(result.counters[name] for result in results) for name in last.counters},
    )


def is_cut_by_topology(result: stiv.EditResult) -> bool:
    """Did the edit stop because the topology would change, without a contact?"""
    return result.status == "blocked" and not result.blocking and result.counters.get("infeasible", 0) > 0


STATUS = "unguarded"


def round_to_storage(control_sets: Sequence[ControlSet], controls: Sequence[Floats]) -> Floats:
    """Controls of each control set, (m, 3), after rounding to storage, as one array."""
    return stack_controls(
        [_stored(control_set, rows) for control_set, rows in zip(control_sets, controls, strict=True)]
    )


def _stored(control_set: ControlSet, controls: Floats) -> Floats:
    if control_set.frame is None:
        return controls
    resting = (controls == control_set.controls).all(axis=1)[:, None]
    rounded = transform_points(control_set.frame, to_single(control_set.frame, controls))
    return np.asarray(np.where(resting, control_set.controls, rounded), np.float64)


def unguarded_result(deformation: stiv.Deformation, controls: Floats) -> stiv.EditResult:
    """The result of an edit that reached its goal with collisions off: status "unguarded"."""
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


def intersecting_objects(pairs: Indices, assembly: Assembly) -> str:
    """Names of the objects in pairs of triangles, (k, 2), of an assembly; "surfaces" if there are none."""
    names = {assembly.face(triangle).object for triangle in np.unique(pairs).tolist()}
    return ", ".join(sorted(names)) if names else "surfaces"
