# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a morph in steps: between them, Blender draws only values that have passed the test."""

from __future__ import annotations

import bpy

from ... import stiv_blender
from ..task_operator import TaskOperator


class MorphInSteps(TaskOperator):
    """Base of the operator; a subclass reports the result."""

    step_seconds = 0.04  # a job waits for each of many short evaluations

    def start_morph(self, context: bpy.types.Context, morph: stiv_blender.MorphTask) -> set[str]:
        """Begin, and return to Blender."""
        self._morph = morph
        return self.start_task(context, morph.solve_steps())

    def restore_scene(self) -> None:
        """Restore the values of the start."""
        self._morph.restore()

    def _advance(self) -> bool:
        is_done = super()._advance()
        self._morph.write_tested()
        return is_done
