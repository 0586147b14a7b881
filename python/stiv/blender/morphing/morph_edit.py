# SPDX-License-Identifier: GPL-3.0-or-later
"""An edit of sliders: they move toward goals until surfaces touch, at once or with each motion of a drag."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence

import bpy
import numpy as np

import stiv
from stiv.blender.controls.garments import stacked_weights
from stiv.blender.edit.sessions import ObjectsIntersectError, body_separations
from stiv.blender.morphing.key_sliders import KeySlider, find_sliders
from stiv.blender.morphing.morphed_scene import MorphedScene
from stiv.blender.scene.arrays import Flags, Floats
from stiv.blender.scene.exclusions import (
    exclude_undecided,
    excluded_bodies,
    find_excluded_triangles,
    intersection_notes,
)
from stiv.blender.scene.torn_seams import torn_seam_note
from stiv.blender.settings import EditSettings, Exclusions
from stiv.blender.verify.verification import Verifier

INCREMENT = 0.04  # longest motion of a vertex in a call, in diagonals of the moving surface
MOST_INCREMENTS = 64
CALLS = 4  # between two Jacobians
GIVEN_WEIGHT = 0.01  # response of the given sliders, if others yield


class MorphEdit:
    """Sliders that move toward goals. The scene shows the values that passed the test of Blender's evaluation.

    With `EditSettings.responders` "unselected" or "all", clothes yield: objects with their own deformation.

    Attributes:
        sliders: those that were read.
        start_notes: about objects that intersect themselves at the start, and about excluded pairs.
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
            ends = [np.where(given, each, self.start) for each in (lower, upper)]
            self._jacobian = scene.simplify(ends, scene.jacobian())
            self._deformation = self._make_deformation(lower, upper)
            loose = scene.leave_out_touching_parts()
            self._session, excluded = _open_session(scene, self._deformation, _weights(scene, given, others_yield))
        except BaseException:
            scene.write(scene.start)
            raise
        self._excluded = exclude_undecided(excluded, scene.assembly, self._session.excluded, ())
        names = {each.owner.name for each in self.sliders}
        self.start_notes = (*intersection_notes(excluded, names, self._excluded), *loose)
        self._verifier = Verifier(scene.assembly, self._session.is_step_free, settings.threads, self._excluded)
        self._shown = scene.start
        self._lower, self._upper = lower, upper
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
        return self._scene.start[: len(self.sliders), 0]

    @property
    def values(self) -> Floats:
        """The values that the scene shows, (k,)."""
        return self._shown[: len(self.sliders), 0]

    @property
    def torn_seam_note(self) -> str:
        """The message on faces at seams that the edit has torn, if they cut each other now; "" without any."""
        if not self._excluded.pairs:
            return ""
        threads = self._scene.settings.threads
        return torn_seam_note(self._scene.assembly, self._excluded, self._session.surface, threads)

    @property
    def has_moved_clothes(self) -> bool:
        """Have clothes yielded?"""
        return not np.array_equal(self._shown[len(self.sliders) :], self._scene.start[len(self.sliders) :])

    def advance(self, goals: Floats, seconds: float = np.inf) -> tuple[stiv.EditResult, bool]:
        """Move toward goals, (k,), in increments; after some seconds, at the end of one.

        Returns the last result, and whether the goals were tried to the end. `show` writes the values.
        """
        end = time.monotonic() + seconds
        before, nearest = self._accepted, np.clip(goals, self._lower, self._upper)
        goals = nearest if self._scene.garments else goals  # limits of scalars alone replace goals beyond them
        longest = self._scene.longest_motion(self._jacobian, nearest - before) / INCREMENT
        count = int(np.clip(np.ceil(longest), 1, MOST_INCREMENTS))
        for number in range(1, count + 1):
            self._renew_jacobian()
            goal = goals if number == count else before + (number / count) * (goals - before)
            budget = None if seconds == np.inf else max(end - time.monotonic(), 0.5 * seconds)
            result = self._session.drag(self._scene.with_values(self._scene.start, goal), time_budget=budget)
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
        for controls in reversed(path):
            accepted = self._scene.evaluate(controls)
            if accepted is None:
                continue
            verification = self._verifier.verify(bpy.context, accepted)
            if verification.passed:
                self._keep(controls, is_last=controls is path[-1])
                return message
            message = message or verification.message
        self._scene.write(self._shown)
        if path:
            self._keep(self._shown, is_last=False)
        return message

    def is_shown(self) -> bool:
        """Does the scene show the values of this edit, and are other objects as at its start?"""
        return self._scene.shows(self._shown)

    def restore(self) -> None:
        """Write the start."""
        self._scene.write(self._scene.start)

    def insert_keyframes(self, context: bpy.types.Context) -> None:
        """Insert keyframes for the values if Auto Keying is on."""
        if context.scene.tool_settings.use_keyframe_insert_auto:
            for slider in self.sliders:
                slider.insert_keyframe()

    @property
    def _accepted(self) -> Floats:
        return self._session.controls[: len(self.sliders), 0].copy()

    def _make_deformation(self, lower: Floats, upper: Floats) -> stiv.ScalarDeformation | stiv.ObservedDeformation:
        scene, count = self._scene, len(self.sliders)
        if not scene.garments:
            return stiv.scalars(scene.evaluate_values, self._jacobian, lower=lower, upper=upper)

        def evaluate(controls: Floats) -> Floats | None:
            values = controls[:count, 0]
            return None if (values < lower).any() or (values > upper).any() else scene.evaluate(controls)

        return stiv.observed(evaluate, scene.blocks(self._jacobian))

    def _note(self, result: stiv.EditResult) -> None:
        self._path += result.path
        self._blocked = result.status == "blocked"
        self._calls += 1

    def _renew_jacobian(self) -> None:
        """Renew the Jacobian sometimes, and after a blocked call."""
        if self._calls and (self._blocked or self._calls % CALLS == 0):
            self._scene.write(self._session.controls)
            self._jacobian = self._scene.jacobian()
            if isinstance(self._deformation, stiv.ScalarDeformation):
                self._deformation.set_jacobian(self._jacobian)
            else:
                self._deformation.set_jacobian(self._scene.blocks(self._jacobian))

    def _keep(self, controls: Floats, is_last: bool) -> None:
        self._shown = controls
        if not is_last:
            self._session.restore(controls)


def _weights(scene: MorphedScene, given: Flags, others_yield: bool) -> Floats:
    """Response weights of all controls: the given sliders go to their goals if others or clothes yield."""
    follows = bool(scene.garments) and scene.settings.responders == "unselected"
    own = 0.0 if follows else GIVEN_WEIGHT if others_yield else 1.0
    return stacked_weights([np.where(given, own, 1.0), *(each.controls.weights for each in scene.garments)])


def _open_session(
    scene: MorphedScene, deformation: stiv.Deformation, weights: Floats
) -> tuple[stiv.EditSession, Exclusions]:
    """A session, and its exclusions, with those of objects that intersect themselves at the start."""
    excluded, controls = scene.settings.excluded, scene.start
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
    deformation: stiv.Deformation,
    weights: Floats,
    excluded: Exclusions,
    controls: Floats,
) -> stiv.EditSession:
    assembly, settings = scene.assembly, scene.settings
    options = stiv.EditOptions(
        **settings.shared(),
        pair_separations=body_separations(assembly, settings),
        weights=weights,
        weight_axes=_weight_axes(scene),
        exclude=find_excluded_triangles(excluded, assembly, assembly.positions, settings.threads),
        overlapping=excluded_bodies(excluded, assembly),
    )
    return stiv.EditSession(assembly.surface, deformation, controls, options)


def _weight_axes(scene: MorphedScene) -> Floats | None:
    axes = [each.controls.weight_axes for each in scene.garments]
    if all(each is None for each in axes):
        return None
    counts = [len(each.controls.controls) for each in scene.garments]
    found = [np.eye(3)[None].repeat(n, 0) if each is None else each for n, each in zip(counts, axes, strict=True)]
    return np.concatenate([np.eye(3)[None].repeat(scene.count, 0), *found])
