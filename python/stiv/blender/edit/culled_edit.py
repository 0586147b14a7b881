# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits in large scenes, without the obstacles and faces of large obstacles that are still distant."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import bpy
import numpy as np
from numpy.typing import ArrayLike

import stiv
from stiv.blender.controls.control_set import Participant
from stiv.blender.controls.motion import Motion
from stiv.blender.controls.participants import find_participants
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.edit.state_writer import WriteReport
from stiv.blender.scene.arrays import Floats, extents
from stiv.blender.scene.culling import CullingBox, find_culling_box
from stiv.blender.settings import EditSettings, check_kind
from stiv.task import Steps, run

MAX_WIDENINGS = 8  # then all obstacles are loaded, which bounds the number of restarts


def begin_culled_edit(context: bpy.types.Context, settings: EditSettings, kind: str) -> CulledEdit | BlenderEdit:
    """Begin an edit as `BlenderEdit.begin` does; in large scenes without distant obstacles.

    Raises the same errors.
    """
    return run(begin_culled_steps(context, settings, kind))


def begin_culled_steps(
    context: bpy.types.Context, settings: EditSettings, kind: str
) -> Steps[CulledEdit | BlenderEdit]:
    """Steps of `begin_culled_edit`; the first reads the scene."""
    check_kind(kind)
    participants = find_participants(context, settings)
    culling = find_culling_box(context, names_of(participants), settings)
    edit = yield from BlenderEdit.begin_with_steps(context, settings, kind, participants, culling=culling)
    return edit if culling is None else CulledEdit(edit, settings, kind, culling)


class CulledEdit:
    """A BlenderEdit with the obstacles of a culling box; undocumented members are those of the inner edit.

    Accepted states stay inside the box, so they cannot intersect the other obstacles. Once a goal or a solution leaves
    the box, an edit with a larger box resumes from the last written state.
    """

    def __init__(self, edit: BlenderEdit, settings: EditSettings, kind: str, culling: CullingBox) -> None:
        self._settings, self._kind = settings, kind
        self._culling: CullingBox | None = culling
        self._edit = edit
        self._written = self._edit.controls
        self._start = np.stack(extents(self._edit.moving_points(self._written)))  # corners of its box, (2, 3)
        self._motion: Motion | ArrayLike | None = None
        self._widened = 0

    def __getattr__(self, name: str) -> Any:
        """All other members of the inner edit."""
        return getattr(self._edit, name)

    @property
    def has_all_obstacles(self) -> bool:
        """Are all obstacles loaded?"""
        return self._culling is None

    def drag(self, motion: Motion | ArrayLike, **execution: Any) -> stiv.EditResult:
        """See BlenderEdit."""
        return run(self.drag_steps(motion, execution.pop("time_budget", None)), **execution)

    def drag_steps(
        self, motion: Motion | ArrayLike, time_budget: float | None = None, hand_over: float | None = None
    ) -> Steps[stiv.EditResult]:
        """See BlenderEdit."""
        self._motion, goal = motion, self._edit.goal_of(motion)
        if self._edit.interference and not self._is_within_box([goal]):
            yield from self._widen([goal])
        result = yield from self._edit.drag_steps(motion, time_budget, hand_over)
        while not self._stays_within_box(result):
            yield from self._widen([goal, *result.path, result.controls])
            result = yield from self._edit.drag_steps(motion, time_budget, hand_over)
        return result

    def settle(self, **execution: Any) -> stiv.EditResult:
        """See BlenderEdit."""
        return run(self.settle_steps(), **execution)

    def settle_steps(self) -> Steps[stiv.EditResult]:
        """See BlenderEdit."""
        goal = self._edit.goal
        result = yield from self._edit.settle_steps()
        while not self._stays_within_box(result):
            yield from self._widen([goal, *result.path, result.controls])
            result = yield from self._edit.drag_to_steps(goal)
        return result

    def set_interference(self, on: bool) -> str:
        """See BlenderEdit. Loads all obstacles first, because surfaces may go anywhere while collisions are off."""
        run(self._restart_within(None))
        return self._edit.set_interference(on)

    def write(self) -> WriteReport:
        """See BlenderEdit."""
        report = self._edit.write()
        self._written = self._edit.controls
        if report.result is not None:  # solved again, along a path that was not checked against the box
            run(self._restart_within(None))
        return report

    def take_state(self) -> None:
        """None: a larger box resumes from the last written state, which the next solve may need at once."""

    def restore(self) -> None:
        """See BlenderEdit."""
        self._edit.restore()
        self._written = self._edit.controls

    def _stays_within_box(self, result: stiv.EditResult) -> bool:
        return not self._edit.interference or self._is_within_box([*result.path, result.controls])

    def _is_within_box(self, states: Iterable[Floats]) -> bool:
        return self._culling is None or all(self._culling.contains(self._edit.moving_points(state)) for state in states)

    def _widen(self, states: Iterable[Floats]) -> Steps[None]:
        """Restart with a box around the start, the displayed state and these states; after several times, without one.

        The present box is left out of it: boxes around boxes soon hold most of a scene.
        """
        if self._culling is None:
            return
        boxes = (extents(self._edit.moving_points(state)) for state in states)
        beyond = np.concatenate([self._start, *boxes])
        self._widened += 1
        participants = find_participants(bpy.context, self._settings)
        few = self._widened <= MAX_WIDENINGS
        yield from self._restart_within(
            find_culling_box(bpy.context, names_of(participants), self._settings, beyond) if few else None
        )

    def _restart_within(self, culling: CullingBox | None) -> Steps[None]:
        """Restart with the obstacles of a box (None: all of them) and resume from the last written state."""
        if self._culling is None:
            return
        shown = self._written
        self._edit.restore()
        participants = find_participants(bpy.context, self._settings)
        self._edit = yield from BlenderEdit.begin_with_steps(
            bpy.context, self._settings, self._kind, participants, culling=culling
        )
        self._culling = culling
        if self._edit.resume_from(shown, self._motion):
            self._edit.write()
        self._written = self._edit.controls


def names_of(participants: Sequence[Participant]) -> set[str]:
    """Names of the participants."""
    return {each.reference.name for each in participants}
