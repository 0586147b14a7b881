# SPDX-License-Identifier: GPL-3.0-or-later
"""The goal of an edit, which follows the motions that the user requests."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from numpy.typing import ArrayLike

from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.motion import Motion
from stiv.blender.edit.sessions import split_controls, stack_controls
from stiv.blender.edit.solver import EditSolver
from stiv.blender.scene.arrays import Floats
from stiv.blender.settings import EditSettings
from stiv.task import Steps


class MotionGoal:
    """The last goal of all controls, and the response that its motion allows.

    Attributes:
        controls: (m, 3).
        motion: the last one; None before the first.
    """

    def __init__(
        self, solver: EditSolver, made: Sequence[ControlSet], controls: Floats, settings: EditSettings
    ) -> None:
        """made: the control sets at the start, which respond to any motion."""
        self.controls = controls
        self.motion: Motion | None = None
        self._solver, self._made, self._settings = solver, made, settings
        self._limits: list[tuple[object, ...]] = [()] * len(made)

    def motion_of(self, motion: Motion | ArrayLike) -> Motion:
        """The motion, without its axis lock if the user lets contact leave it."""
        chosen = Motion.of(motion)
        return replace(chosen, free=None) if self._settings.slide_out_of_axis else chosen

    def limit_steps(self, motion: Motion) -> Steps[None]:
        """Steps that let the controls respond as the motion allows: its axis lock, pivot and proportional editing."""
        limits = [each.rule.limits(motion) for each in self._made]
        if limits != self._limits:
            weight = self._settings.response_weight(True)
            yield from self._solver.change_response([each.rule.limited(each, motion, weight) for each in self._made])
            self._limits = limits

    def controls_for(self, motion: Motion) -> Floats:
        """The goal, (m, 3), of a motion."""
        sets = self._solver.control_sets
        last = split_controls(self.controls, sets)
        return stack_controls(
            [each.rule.goal(each.controls, old, motion) for each, old in zip(sets, last, strict=True)]
        )
