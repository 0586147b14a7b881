# SPDX-License-Identifier: GPL-3.0-or-later
"""An edit of sliders: they move toward goals until surfaces touch, at once or with each motion of a drag."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence

import bpy
import numpy as np

import stiv
from stiv.blender.morphing.key_sliders import KeySlider, find_sliders
from stiv.blender.morphing.morph_session import MorphSession, SliderLimits
from stiv.blender.morphing.morphed_scene import MorphedScene
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.torn_seams import torn_seam_note
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import Verifier
from stiv.task import Steps, run

INCREMENT = 0.04  # longest motion of a vertex in a call, in diagonals of the moving surface
MOST_INCREMENTS = 64


class MorphEdit:
    """Sliders that move toward goals. The scene shows the values that passed the test of Blender's evaluation.

    With `EditSettings.responders` "unselected" or "all", clothes yield: objects with their own deformation.

    Methods whose name ends with ``_steps`` return the same work for a stiv.blender.Task, which solves in jobs. Between
    their steps, the scene shows any values; see `MorphedScene.write_tested`.

    Attributes:
        sliders: those that were read.
        start_notes: about objects that intersect themselves at the start, and about excluded pairs.
    """

    def __init__(
        self, scene: MorphedScene, sliders: Sequence[KeySlider], session: MorphSession, limits: SliderLimits
    ) -> None:
        """Use `begin` or `begin_with`."""
        self._scene, self._session, self._limits = scene, session, limits
        self.sliders, self.start_notes = tuple(sliders), session.notes
        self._verifier = Verifier(scene.assembly, session.core.is_step_free, scene.settings.threads, session.excluded)
        self._path: list[Floats] = []

    @classmethod
    def begin(
        cls,
        context: bpy.types.Context,
        values: Mapping[str, Mapping[str, float]],
        settings: EditSettings,
        *,
        others_yield: bool = False,
    ) -> MorphEdit:
        """Begin a drag of some sliders within their whole ranges. Arguments and errors are those of `morph`."""
        sliders, _, given = find_sliders(values, others_yield)
        lower, upper = (np.array([getattr(each, name) for each in sliders]) for name in ("lower", "upper"))
        return cls.begin_with(context, settings, sliders, SliderLimits(np.array(given), lower, upper, others_yield))

    @classmethod
    def begin_with(
        cls, context: bpy.types.Context, settings: EditSettings, sliders: Sequence[KeySlider], limits: SliderLimits
    ) -> MorphEdit:
        """Read the scene, which then shows the start. Raises InputError, StartIntersectsError, with nothing changed."""
        return run(cls.begin_in_steps(MorphedScene(context, settings, sliders), sliders, limits))

    @classmethod
    def begin_in_steps(
        cls, scene: MorphedScene, sliders: Sequence[KeySlider], limits: SliderLimits
    ) -> Steps[MorphEdit]:
        """Steps that begin in a scene of these sliders. If they raise or are closed, it shows the start."""
        try:
            return cls(scene, sliders, (yield from MorphSession.open_steps(scene, limits)), limits)
        except BaseException:
            scene.restore()
            raise

    def goals(self, values: Mapping[str, Mapping[str, float]]) -> Floats:
        """The given values of the sliders, and those of the start for all others, (k,)."""
        found = [values.get(each.owner.name, {}).get(each.key, each.start) for each in self.sliders]
        return np.array(found, np.float64)

    @property
    def start(self) -> Floats:
        """The values at the start, (k,)."""
        return self._scene.start[: len(self.sliders), 0]

    @property
    def values(self) -> Floats:
        """The values that the scene shows, (k,)."""
        return self._scene.tested[: len(self.sliders), 0]

    @property
    def torn_seam_note(self) -> str:
        """The message on faces at seams that the edit has torn, if they cut each other now; "" without any."""
        excluded, threads = self._session.excluded, self._scene.settings.threads
        if not len(excluded):
            return ""
        return torn_seam_note(self._scene.assembly, excluded, self._session.core.surface, threads)

    @property
    def has_moved_clothes(self) -> bool:
        """Have clothes yielded?"""
        clothes = slice(len(self.sliders), None)
        return not np.array_equal(self._scene.tested[clothes], self._scene.start[clothes])

    def advance(self, goals: Floats, seconds: float = np.inf) -> tuple[stiv.EditResult, bool]:
        """Move toward goals, (k,), in increments; after some seconds, at the end of one.

        Returns the last result, and whether the goals were tried to the end. `show` writes the values.
        """
        return run(self.advance_steps(goals, seconds))

    def advance_steps(self, goals: Floats, seconds: float = np.inf) -> Steps[tuple[stiv.EditResult, bool]]:
        """Steps of `advance`. Raise CancelledError."""
        end = time.monotonic() + seconds
        before, nearest = self._accepted, np.clip(goals, self._limits.lower, self._limits.upper)
        goals = nearest if self._scene.garments else goals  # limits of scalars alone replace goals beyond them
        longest = self._scene.longest_motion(self._session.jacobian, nearest - before) / INCREMENT
        count = int(np.clip(np.ceil(longest), 1, MOST_INCREMENTS))
        for number in range(1, count + 1):
            yield (number - 1) / count
            goal = goals if number == count else before + (number / count) * (goals - before)
            budget = None if seconds == np.inf else max(end - time.monotonic(), 0.5 * seconds)
            result = yield from self._session.drag_steps(goal, budget)
            self._path += result.path
            if number < count and time.monotonic() > end:
                return result, False
        return result, result.status != "budget"

    def settle(self) -> stiv.EditResult:
        """Solve again toward the last goals. `show` writes the values."""
        return run(self.settle_steps())

    def settle_steps(self) -> Steps[stiv.EditResult]:
        """Steps of `settle`. Raise CancelledError."""
        result = yield from self._session.settle_steps()
        self._path += result.path
        return result

    def show(self) -> str:
        """Write the last values that pass the test of Blender's evaluation; returns why later ones did not, or ""."""
        path, self._path, message = self._path, [], ""
        for controls in reversed(path):
            accepted = self._scene.evaluate(controls)
            if accepted is None:
                continue
            verification = self._verifier.verify(bpy.context, accepted)
            if verification.passed:
                self._keep(controls, is_last=controls is path[-1])
                return message
            message = message or verification.message
        self._scene.write(self._scene.tested)
        if path:
            self._keep(self._scene.tested, is_last=False)
        return message

    def is_shown(self) -> bool:
        """Does the scene show the values of this edit, and are other objects as at its start?"""
        return self._scene.shows(self._scene.tested)

    def restore(self) -> None:
        """Write the start."""
        self._scene.restore()

    def insert_keyframes(self, context: bpy.types.Context) -> None:
        """Insert keyframes for the values if Auto Keying is on."""
        if context.scene.tool_settings.use_keyframe_insert_auto:
            for slider in self.sliders:
                slider.insert_keyframe()

    @property
    def _accepted(self) -> Floats:
        return self._session.core.controls[: len(self.sliders), 0].copy()

    def _keep(self, controls: Floats, is_last: bool) -> None:
        self._scene.tested = controls
        if not is_last:
            self._session.core.restore(controls)
