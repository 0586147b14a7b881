# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a morph in steps: between them, Blender draws only values that have passed the test."""

from __future__ import annotations

import time

import bpy

from ... import stiv_blender
from ..task_operator import TaskOperator

SHORTEST, LONGEST = 0.04, 0.2  # seconds of a look at the task


class MorphInSteps(TaskOperator):
    """Base of the operator; a subclass reports the result."""

    def start_morph(self, context: bpy.types.Context, morph: stiv_blender.MorphTask) -> set[str]:
        """Begin, and return to Blender."""
        self._morph, self._looked = morph, time.perf_counter()
        return self.start_task(context, morph.solve_steps())

    def restore_scene(self) -> None:
        """Restore the values of the start."""
        self._morph.restore()

    def write_between_looks(self) -> None:
        """Write values that have passed the test."""
        self._morph.write_tested()
        self._looked = time.perf_counter()

    def _advance(self) -> bool:
        """Look for as long as Blender has drawn since the last look: it draws after each, and meanwhile a job waits."""
        self.step_seconds = min(max(SHORTEST, time.perf_counter() - self._looked), LONGEST)
        return super()._advance()
