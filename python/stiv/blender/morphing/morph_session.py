# SPDX-License-Identifier: GPL-3.0-or-later
"""The session of a morph: sliders and clothes respond, and the Jacobian that directs them is renewed on the way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import stiv
from stiv.blender.controls.garments import stacked_weights
from stiv.blender.edit.sessions import ObjectsIntersectError, body_separations, open_session
from stiv.blender.excluded_faces import Exclusions
from stiv.blender.morphing.morphed_scene import MorphedScene
from stiv.blender.scene.arrays import Flags, Floats
from stiv.blender.scene.exclusions import (
    exclude_undecided,
    excluded_bodies,
    find_excluded_triangles,
    intersection_notes,
)
from stiv.task import Call, Steps

CALLS = 4  # between two Jacobians
GIVEN_WEIGHT = 0.01  # response of the given sliders, if others yield


@dataclass(frozen=True)
class SliderLimits:
    """How the sliders of a morph may move.

    Attributes:
        given: those that goals move, (k,).
        lower, upper: limits, (k,).
        others_yield: the other sliders respond.
    """

    given: Flags
    lower: Floats
    upper: Floats
    others_yield: bool = False


class MorphSession:
    """A session that moves sliders and clothes.

    Attributes:
        core: the session of the core.
        jacobian: derivative of the surface by the sliders, (N, 3, k).
        excluded: pairs that may intersect, with those of objects that intersect themselves at the start.
        notes: about these objects, loose parts and excluded pairs.
    """

    def __init__(
        self,
        scene: MorphedScene,
        core: stiv.EditSession,
        deformation: stiv.ScalarDeformation | stiv.ObservedDeformation,
        jacobian: Floats,
        excluded: Exclusions,
        notes: tuple[str, ...],
    ) -> None:
        """Use `open_steps`."""
        self._scene, self._deformation = scene, deformation
        self.core, self.jacobian, self.excluded, self.notes = core, jacobian, excluded, notes
        self._blocked, self._calls = False, 0

    @classmethod
    def open_steps(cls, scene: MorphedScene, limits: SliderLimits) -> Steps[MorphSession]:
        """Steps that open a session at the start of a scene. Raise InputError, StartIntersectsError."""
        start = scene.start[: scene.count, 0]
        ends = [np.where(limits.given, each, start) for each in (limits.lower, limits.upper)]
        jacobian = yield from scene.jacobian_steps(scene.start)
        jacobian = yield from scene.simplify_steps(ends, jacobian)
        yield None
        deformation = yield from _deformation_steps(scene, jacobian, limits)
        loose = scene.leave_out_touching_parts()
        yield None
        core, excluded = yield from _open_core(scene, deformation, _weights(scene, limits))
        found = exclude_undecided(excluded, scene.assembly, core.excluded, ())
        notes = (*intersection_notes(excluded, set(scene.owners), found), *loose)
        return cls(scene, core, deformation, jacobian, found, notes)

    def drag_steps(self, values: Floats, time_budget: float | None) -> Steps[stiv.EditResult]:
        """Steps of a drag to values of the sliders, (k,); sometimes, and after a blocked call, with a new Jacobian."""
        if self._calls and (self._blocked or self._calls % CALLS == 0):
            yield from self._renew_jacobian()
        goal = self._scene.with_values(self._scene.start, values)
        return (yield from self._solve(Call(self.core.drag, self.core.start_drag, goal, time_budget=time_budget)))

    def settle_steps(self) -> Steps[stiv.EditResult]:
        """Steps that solve again toward the last goal."""
        return (yield from self._solve(Call(self.core.settle, self.core.start_settle)))

    def _solve(self, call: Call[stiv.EditResult]) -> Steps[stiv.EditResult]:
        result: stiv.EditResult = yield call
        if result.status == "cancelled":
            raise stiv.CancelledError("cancelled")
        self._blocked = result.status == "blocked"
        self._calls += 1
        return result

    def _renew_jacobian(self) -> Steps[None]:
        at = self.core.controls
        self.jacobian = yield from self._scene.jacobian_steps(at)
        if isinstance(self._deformation, stiv.ScalarDeformation):
            self._deformation.set_jacobian(self.jacobian)
        else:
            self._deformation.set_jacobian((yield from self._scene.blocks_steps(self.jacobian, at)))


def _deformation_steps(
    scene: MorphedScene, jacobian: Floats, limits: SliderLimits
) -> Steps[stiv.ScalarDeformation | stiv.ObservedDeformation]:
    lower, upper = limits.lower, limits.upper
    if not scene.garments:
        return stiv.scalars(scene.evaluate_values, jacobian, lower=lower, upper=upper)

    def evaluate(controls: Floats) -> Floats | None:
        values = controls[: scene.count, 0]
        return None if (values < lower).any() or (values > upper).any() else scene.evaluate(controls)

    return stiv.observed(evaluate, (yield from scene.blocks_steps(jacobian, scene.start)))


def _weights(scene: MorphedScene, limits: SliderLimits) -> Floats:
    """Response weights of all controls: the given sliders go to their goals if others or clothes yield."""
    follows = bool(scene.garments) and scene.settings.responders == "unselected"
    own = 0.0 if follows else GIVEN_WEIGHT if limits.others_yield else 1.0
    return stacked_weights([np.where(limits.given, own, 1.0), *(each.controls.weights for each in scene.garments)])


def _open_core(
    scene: MorphedScene, deformation: stiv.Deformation, weights: Floats
) -> Steps[tuple[stiv.EditSession, Exclusions]]:
    """Steps to a session, and its exclusions, with those of objects that intersect themselves at the start."""
    excluded = scene.settings.excluded
    try:
        return (yield from _make_core(scene, deformation, weights, excluded)), excluded
    except stiv.StartIntersectsError as error:
        excluded = exclude_undecided(excluded, scene.assembly, error.pairs, ())
    yield None
    try:
        return (yield from _make_core(scene, deformation, weights, excluded)), excluded
    except stiv.StartIntersectsError as error:
        raise ObjectsIntersectError(error, scene.assembly) from error


def _make_core(
    scene: MorphedScene, deformation: stiv.Deformation, weights: Floats, excluded: Exclusions
) -> Steps[stiv.EditSession]:
    assembly, settings = scene.assembly, scene.settings
    options = stiv.EditOptions(
        **settings.shared(),
        pair_separations=body_separations(assembly, settings),
        weights=weights,
        weight_axes=_weight_axes(scene),
        exclude=find_excluded_triangles(excluded, assembly, assembly.positions, settings.threads),
        parts_may_cut=True,  # values of shape keys tear seams
        overlapping=excluded_bodies(excluded, assembly),
    )
    core: stiv.EditSession = yield Call(
        open_session, stiv.EditSession.start, assembly.surface, deformation, scene.start, options
    )
    return core


def _weight_axes(scene: MorphedScene) -> Floats | None:
    axes = [each.controls.weight_axes for each in scene.garments]
    if all(each is None for each in axes):
        return None
    counts = [len(each.controls.controls) for each in scene.garments]
    found = [np.eye(3)[None].repeat(n, 0) if each is None else each for n, each in zip(counts, axes, strict=True)]
    return np.concatenate([np.eye(3)[None].repeat(scene.count, 0), *found])
