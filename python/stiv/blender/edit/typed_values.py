# SPDX-License-Identifier: GPL-3.0-or-later
"""Applies a typed value as a drag would: in increments, each of which is solved for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

import stiv
from stiv.blender.controls.motion import Motion
from stiv.blender.edit.increments import StillIncrements
from stiv.blender.edit.results import merge_results
from stiv.blender.scene.arrays import Floats
from stiv.deadlines import deadline_after, is_over, time_left
from stiv.task import Steps


class DraggedEdit(Protocol):
    """An edit that increments can drag; see `BlenderEdit`."""

    @property
    def controls(self) -> Floats:
        """Accepted controls, (m, 3)."""

    @property
    def goal(self) -> Floats:
        """Their goal, (m, 3)."""

    def aim_at(self, motion: Motion) -> None:
        """Take the goal of a motion without solving for it."""

    def drag_steps(self, motion: Motion, time_budget: float | None = None) -> Steps[stiv.EditResult]:
        """Steps that solve for a motion."""

    def settle_steps(self) -> Steps[stiv.EditResult]:
        """Steps that solve again toward the last goal."""


def apply_increments(
    edit: DraggedEdit, increments: Sequence[Motion], may_skip: bool, time_budget: float
) -> Steps[stiv.EditResult]:
    """Steps that drag an edit through motions, and settle it at the last one.

    may_skip: the last increment follows at once where contact holds the controls for several ones. time_budget: seconds
    of all solves; 0: no limit.
    """
    results: list[stiv.EditResult] = []
    still, end = StillIncrements(), deadline_after(time_budget)
    for number, increment in enumerate(increments, 1):
        if may_skip and still.are_many and number < len(increments):
            continue
        yield (number - 1) / len(increments)
        results.append((yield from _drag_increment(edit, increment, still, end)))
        if results[-1].status in ("cancelled", "budget"):
            return merge_results(results)
        if _only_goes_deeper(results[-1]):
            edit.aim_at(increments[-1])
            return merge_results(results)
        if is_over(end) and (number < len(increments) or results[-1].status != "reached"):
            return replace(merge_results(results), status="budget")
    return merge_results([*results, (yield from edit.settle_steps())])


def _drag_increment(edit: DraggedEdit, increment: Motion, still: StillIncrements, end: float) -> Steps[stiv.EditResult]:
    """Steps of one increment, until the deadline `end`."""
    controls, goal = edit.controls, edit.goal
    result = yield from edit.drag_steps(increment, time_left(end) or None)
    still.add(edit.controls - controls, edit.goal - goal)
    return result


def _only_goes_deeper(result: stiv.EditResult) -> bool:
    """Did nothing move because overlapping objects would overlap more? Then each further increment would fail alike."""
    return result.status == "blocked" and len(result.events) == 0 and len(result.path) == 0
