# SPDX-License-Identifier: GPL-3.0-or-later
"""The goals that a tool's changes are for an edit, and the response of the controls that it changed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.directions import ALL_FREE, NONE_FREE
from stiv.blender.controls.joined_seams import seam_message
from stiv.blender.controls.motion import Motion
from stiv.blender.controls.placement_goals import RotationGoal, respond
from stiv.blender.controls.points import PointGoal, point_weights
from stiv.blender.guard.changes import Change
from stiv.blender.guard.scene_state import ObjectState, SceneState
from stiv.blender.guard.tool_motion import tool_motion
from stiv.blender.scene.arrays import Flags, Floats, Indices, transform_points
from stiv.blender.settings import EditSettings


@dataclass(frozen=True)
class ToolGoals:
    """A tool's changes by the object's name: the change, the state after it, and the motion of placed objects."""

    changes: dict[str, Change]
    after: dict[str, ObjectState]
    motions: dict[str, Motion]

    @staticmethod
    def between(present: SceneState, wanted: SceneState, changes: Sequence[Change]) -> ToolGoals:
        """The goals of changes from the present state to the wanted one."""
        states = {each.reference.name: (present[number], wanted[number]) for each, number in _numbered(changes)}
        by_name = {each.reference.name: each for each in changes}
        motions = {name: tool_motion(each, *states[name]) for name, each in by_name.items() if each.placed}
        return ToolGoals(by_name, {name: after for name, (_, after) in states.items()}, motions)

    def change_of(self, control_set: ControlSet) -> Change | None:
        """The change of the first object of a control set that the tool changed."""
        return next((self.changes[name] for name in control_set.names if name in self.changes), None)


def _numbered(changes: Sequence[Change]) -> Iterator[tuple[Change, int]]:
    return ((change, change.reference.session_uid) for change in changes)


def with_response(control_set: ControlSet, goals: ToolGoals, settings: EditSettings) -> ControlSet:
    """Give what the tool changed the response that an edit of the same kind gives."""
    change = goals.change_of(control_set)
    if change is None:
        return control_set
    weight = settings.response_weight(True)
    if change.points is None:
        return _with_placement_response(control_set, change, goals.motions[change.reference.name], weight)
    moved = change.points[_followed_vertices(control_set, change)]
    return replace(
        control_set,
        weights=point_weights(moved, weight, settings.response_weight(False), control_set.max_weights),
        rule=PointGoal(moved, control_set.controls),
        note=""
        if control_set.control_seams is None
        else seam_message(control_set.names[0], change.points, control_set.control_seams),
    )


def _with_placement_response(control_set: ControlSet, change: Change, motion: Motion, weight: float) -> ControlSet:
    """A rotation responds by its angle, a uniform scale by one factor; what only moved turns if settings allow it."""
    rule = control_set.rule
    if isinstance(rule, RotationGoal) and not change.turned and not rule.free_axis:
        return respond(control_set, ALL_FREE.within(rule.free), NONE_FREE, weight)
    return rule.limited(control_set, motion, weight)


def controls_after(control_set: ControlSet, goals: ToolGoals) -> Floats:
    """Controls after the tool, (m, 3)."""
    change = goals.change_of(control_set)
    if change is None:
        return control_set.controls
    name = change.reference.name
    points = goals.after[name].points
    if control_set.frame is not None and points is not None and change.points is not None:
        return transform_points(control_set.frame, points[_followed_vertices(control_set, change)])
    return control_set.rule.goal(control_set.controls, control_set.controls, goals.motions[name])


def _followed_vertices(control_set: ControlSet, change: Change) -> Indices:
    """The vertex or point that each control follows, (m,); on a seam, one that the tool moved."""
    assert change.points is not None
    chosen = _unmirrored_vertices(control_set, change.points)
    return chosen if control_set.kept is None else chosen[control_set.kept]


def _unmirrored_vertices(control_set: ControlSet, changed: Flags) -> Indices:
    if control_set.control_seams is None:
        return np.arange(len(changed), dtype=np.int32)
    chosen = control_set.control_seams.first.copy()
    moved = np.flatnonzero(changed)[::-1].astype(np.int32)
    chosen[control_set.control_seams.index[moved]] = moved
    return chosen
