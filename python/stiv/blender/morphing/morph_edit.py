# SPDX-License-Identifier: GPL-3.0-or-later
"""An edit of sliders: they move toward goals until surfaces touch, at once or with each motion of a drag."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence

import bpy
import numpy as np

import stiv
from stiv.blender.edit.sessions import ObjectsIntersectError, body_separations
from stiv.blender.morphing.key_sliders import KeySlider, find_sliders
from stiv.blender.morphing.morphed_scene import MorphedScene
from stiv.blender.scene.arrays import Flags, Floats
from stiv.blender.scene.exclusions import exclude_undecided, excluded_bodies, find_excluded_triangles
from stiv.blender.settings import EditSettings, Exclusions
from stiv.blender.verify.verification import Verifier

INCREMENT = 0.04  # longest motion of a vertex in a call, in diagonals of the moving surface
MOST_INCREMENTS = 64
CALLS = 4  # between two Jacobians
GIVEN_WEIGHT = 0.01  # response of the given sliders, if others yield


class MorphEdit:
    """Sliders that move toward goals. The scene shows the values that passed the test of Blender's evaluation.

    Attributes:
        sliders: those that were read.
        values: theirs that the scene shows, (k,).
    """

    def __init__(
        self,
        context: bpy.types.Context,
        settings: EditSettings,
        sliders: Sequence[KeySlider],
        given: Flags,
        lower: Floats | None = None,
        upper: Floats | None = None,
        others_yield: bool = False,
    ) -> None:
        """Read the scene, which then shows the start.

        given: the sliders that goals move, (k,). lower, upper: narrower limits than those of the sliders, (k,).
        others_yield: the other sliders respond. Raises InputError, StartIntersectsError, with nothing changed.
        """
        self.sliders = tuple(sliders)
        scene = self._scene = MorphedScene(context, settings, sliders)
        lower = scene.lower if lower is None else lower
        upper = scene.upper if upper is None else upper
        try:
            self._jacobian = scene.jacobian()
            ends = [np.where(given, each, scene.start) for each in (lower, upper)]
            scene.fix_resting_objects(ends, self._jacobian)
            self._deformation = stiv.scalars(scene.evaluate, self._jacobian, lower=lower, upper=upper)
            weights = np.where(given & others_yield, GIVEN_WEIGHT, 1.0)
            self._session, excluded = _open_session(scene, self._deformation, weights)
        except BaseException:
            scene.write(scene.start)
            raise
        self._verifier = Verifier(scene.assembly, self._session.is_step_free, settings.threads, excluded)
        self.values = scene.start
        self._path: list[Floats] = []
        self._blocked, self._calls = False, 0

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
        return cls(context, settings, sliders, np.array(given), others_yield=others_yield)

    def goals(self, values: Mapping[str, Mapping[str, float]]) -> Floats:
        """The given values of the sliders, and those of the start for all others, (k,)."""
        found = [values.get(each.owner.name, {}).get(each.key, each.start) for each in self.sliders]
        return np.array(found, np.float64)

    @property
    def start(self) -> Floats:
        """The values at the start, (k,)."""
        return self._scene.start

    def advance(self, goals: Floats, seconds: float = np.inf) -> tuple[stiv.EditResult, bool]:
        """Move toward goals, (k,), in increments; after some seconds, at the end of one.

        Returns the last result, and whether the goals were tried to the end. `show` writes the values.
        """
        end = time.monotonic() + seconds
        before, nearest = self._accepted, np.clip(goals, self._scene.lower, self._scene.upper)
        longest = self._scene.longest_motion(self._jacobian, nearest - before) / INCREMENT
        count = int(np.clip(np.ceil(longest), 1, MOST_INCREMENTS))
        for number in range(1, count + 1):
            self._renew_jacobian()
            goal = goals if number == count else before + (number / count) * (goals - before)
            budget = None if seconds == np.inf else max(end - time.monotonic(), 0.5 * seconds)
            result = self._session.drag(self._deformation.controls(goal), time_budget=budget)
            self._note(result)
            if number < count and time.monotonic() > end:
                return result, False
        return result, result.status != "budget"

    def settle(self) -> stiv.EditResult:
        """Solve again toward the last goals. `show` writes the values."""
        result = self._session.settle()
        self._note(result)
        return result

    def show(self) -> str:
        """Write the last values that pass the test of Blender's evaluation; returns why later ones did not, or ""."""
        path, self._path, message = self._path, [], ""
        for values in reversed(path):
            accepted = self._scene.evaluate(values)
            if accepted is None:
                continue
            verification = self._verifier.verify(bpy.context, accepted)
            if verification.passed:
                self._keep(values, is_last=values is path[-1])
                return message
            message = message or verification.message
        self._scene.write(self.values)
        if path:
            self._keep(self.values, is_last=False)
        return message

    def is_shown(self) -> bool:
        """Does the scene show the values of this edit, and are other objects as at its start?"""
        return self._scene.shows(self.values)

    def restore(self) -> None:
        """Write the values of the start."""
        self._scene.write(self._scene.start)

    def insert_keyframes(self, context: bpy.types.Context) -> None:
        """Insert keyframes for the values if Auto Keying is on."""
        if context.scene.tool_settings.use_keyframe_insert_auto:
            for slider in self.sliders:
                slider.insert_keyframe()

    @property
    def _accepted(self) -> Floats:
        return self._deformation.values(self._session.controls)

    def _note(self, result: stiv.EditResult) -> None:
        self._path += [self._deformation.values(each) for each in result.path]
        self._blocked = result.status == "blocked"
        self._calls += 1

    def _renew_jacobian(self) -> None:
        """Renew the Jacobian sometimes, and after a blocked call."""
        if self._calls and (self._blocked or self._calls % CALLS == 0):
            self._scene.write(self._accepted)
            self._jacobian = self._scene.jacobian()
            self._deformation.set_jacobian(self._jacobian)

    def _keep(self, values: Floats, is_last: bool) -> None:
        self.values = values
        if not is_last:
            self._session.restore(self._deformation.controls(values))


def _open_session(
    scene: MorphedScene, deformation: stiv.ScalarDeformation, weights: Floats
) -> tuple[stiv.EditSession, Exclusions]:
    """A session, and its exclusions, with those of objects that intersect themselves at the start."""
    excluded, controls = scene.settings.excluded, deformation.controls(scene.start)
    try:
        return _make_session(scene, deformation, weights, excluded, controls), excluded
    except stiv.StartIntersectsError as error:
        excluded = exclude_undecided(excluded, scene.assembly, error.pairs, ())
    try:
        return _make_session(scene, deformation, weights, excluded, controls), excluded
    except stiv.StartIntersectsError as error:
        raise ObjectsIntersectError(error, scene.assembly) from error


def _make_session(
    scene: MorphedScene,
    deformation: stiv.ScalarDeformation,
    weights: Floats,
    excluded: Exclusions,
    controls: Floats,
) -> stiv.EditSession:
    assembly, settings = scene.assembly, scene.settings
    options = stiv.EditOptions(
        **settings.shared(),
        pair_separations=body_separations(assembly, settings),
        weights=weights,
        exclude=find_excluded_triangles(excluded, assembly, assembly.positions, settings.threads),
        overlapping=excluded_bodies(excluded, assembly),
    )
    return stiv.EditSession(assembly.surface, deformation, controls, options)
