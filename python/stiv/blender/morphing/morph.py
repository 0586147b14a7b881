# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves values of shape keys toward goals, and stops where surfaces touch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.edit.sessions import ObjectsIntersectError, body_separations
from stiv.blender.morphing.key_sliders import KeySlider, find_sliders
from stiv.blender.scene.arrays import Flags, Floats
from stiv.blender.scene.assembly import assemble
from stiv.blender.scene.exclusions import exclude_undecided, excluded_bodies, find_excluded_triangles
from stiv.blender.scene.guarded_evaluations import read_guarded_scene
from stiv.blender.scene.references import SceneChangedError
from stiv.blender.scene.triangulation_flips import guard_bent_quads
from stiv.blender.settings import EditSettings, Exclusions
from stiv.blender.verify.verification import Verifier, read_shown

INCREMENT = 0.04  # longest motion of a vertex in a call, in diagonals of the moving surface
MOST_INCREMENTS = 64
CALLS = 4  # between two Jacobians
DIFFERENCE = 0.05  # of the range of a slider, for a Jacobian
OWN_SLIDER = 1.0  # range of a slider without a range
GIVEN_WEIGHT = 0.01  # response of the given sliders, if others yield


@dataclass(frozen=True)
class MorphReport:
    """The result of a morph.

    Attributes:
        status: of stiv.EditResult.
        values: (object, key) and its value now, of each slider that was read.
        blocking: names of the objects in contact when blocked.
    """

    status: str
    values: Mapping[tuple[str, str], float]
    blocking: tuple[str, ...] = ()


def morph(
    context: bpy.types.Context,
    values: Mapping[str, Mapping[str, float]],
    settings: EditSettings,
    *,
    others_yield: bool = False,
) -> MorphReport:
    """Move values of shape keys toward goals, and write the closest ones without intersections.

    Blender evaluates the scene, so groups, relative keys, muted keys, modifiers and objects that follow the shape have
    their effect. Goals beyond the range of a slider end at it. No given slider passes its goal. All other objects stay.
    Keyframes are inserted if Auto Keying is on.

    values        goals by names of object and key, such as {"Body": {"Wide": 1.0}}
    settings      separation, guard, roles and exclusions; the other choices have no effect
    others_yield  the other sliders of these objects respond too, so that the given ones come closer to their goals

    Raises InputError naming object and key, StartIntersectsError if objects intersect at the start; nothing changed.
    """
    sliders, goals, given = find_sliders(values, others_yield)
    scene = _MorphedScene(context, settings, sliders)
    try:
        result = _solve(scene, np.array(goals), np.array(given), others_yield)
    except BaseException:
        scene.write(scene.start)
        raise
    if context.scene.tool_settings.use_keyframe_insert_auto:
        for slider in sliders:
            slider.insert_keyframe()
    found = dict(zip([(each.owner.name, each.key) for each in sliders], scene.written.tolist(), strict=True))
    return MorphReport(result.status, found, result.blocking)


class _MorphedScene:
    """The surface of all visible objects as a function of sliders, evaluated in the scene itself.

    Attributes:
        assembly: objects that no slider moves are fixed.
        start: the values at the start, (k,).
        written: the values that Blender shows, (k,).
    """

    def __init__(self, context: bpy.types.Context, settings: EditSettings, sliders: Sequence[KeySlider]) -> None:
        self._context, self._sliders, self.settings = context, sliders, settings
        self.start = self.written = np.array([each.start for each in sliders])
        self.lower, self.upper = (np.array(ends) for ends in zip(*((s.lower, s.upper) for s in sliders), strict=True))
        scene, _ = read_guarded_scene(context, settings)
        self.assembly = assemble(scene.meshes, ["deformable"] * len(scene.meshes), (), settings.ignored_pairs)
        self._rest = self.assembly.positions
        self._fixed = np.zeros(len(self._rest), bool)

    def write(self, values: Floats) -> None:
        """Write values, (k,), and update Blender's evaluation."""
        for slider, value, before in zip(self._sliders, values, self.written, strict=True):
            if value != before:
                slider.write(float(value))
        self.written = values
        self._context.view_layer.update()

    def evaluate(self, values: Floats) -> Floats | None:
        """The surface at values, (N, 3); None if its topology, or something that no slider moves, changes."""
        self.write(values)
        try:
            positions = read_shown(self._context, self.assembly)
        except SceneChangedError:
            return None
        return positions if np.array_equal(positions[self._fixed], self._rest[self._fixed]) else None

    def jacobian(self) -> Floats:
        """The derivative of the surface at the present values, (N, 3, k). Writes other values."""
        ranges = np.where(self.upper > self.lower, self.upper - self.lower, OWN_SLIDER)
        at = self.written
        found = stiv.difference_jacobian(
            self.evaluate, at, DIFFERENCE * np.minimum(ranges, OWN_SLIDER), lower=self.lower, upper=self.upper
        )
        self.write(at)
        return found

    def fix_resting_objects(self, goal: Floats, jacobian: Floats) -> None:
        """Fix the objects that neither the Jacobian nor the goal, (k,), moves."""
        moved = (jacobian != 0).any(axis=(1, 2))
        at_goal = self.evaluate(goal)
        self.write(self.start)
        if at_goal is not None:
            moved |= (at_goal != self._rest).any(axis=1)
        moves = [bool(moved[a:b].any()) for a, b in pairwise(self.assembly.starts)]
        mobility = ["deformable" if each else "fixed" for each in moves]
        meshes, ignored = self.assembly.meshes, self.settings.ignored_pairs
        self.assembly = guard_bent_quads(assemble(meshes, mobility, (), ignored), self.settings.threads)
        self._fixed = ~np.repeat(moves, np.diff(self.assembly.starts))

    @property
    def moving(self) -> Flags:
        """The vertices that sliders may move, (N,)."""
        return ~self._fixed


def _solve(scene: _MorphedScene, goals: Floats, given: Flags, others_yield: bool) -> stiv.EditResult:
    """Move the sliders toward their goals, and leave the scene at the closest values that Blender shows free."""
    jacobian = scene.jacobian()
    nearest = np.clip(goals, scene.lower, scene.upper)
    scene.fix_resting_objects(nearest, jacobian)
    lower = np.where(given, np.minimum(scene.start, nearest), scene.lower)
    upper = np.where(given, np.maximum(scene.start, nearest), scene.upper)
    deformation = stiv.scalars(scene.evaluate, jacobian, lower=lower, upper=upper)
    session, excluded = _open_session(scene, deformation, np.where(given & others_yield, GIVEN_WEIGHT, 1.0))
    shift = np.einsum("nak,k->na", jacobian[scene.moving], nearest - scene.start)
    diagonal = np.linalg.norm(np.ptp(scene.assembly.positions[scene.moving], axis=0)) if scene.moving.any() else 1.0
    longest = float(np.linalg.norm(shift, axis=1).max(initial=0.0)) / (INCREMENT * float(diagonal) or 1.0)
    count = int(np.clip(np.ceil(longest), 1, MOST_INCREMENTS))
    path = [scene.start]
    for number in range(1, count + 1):
        goal = scene.start + (number / count) * (goals - scene.start)
        result = session.drag(deformation.controls(goal))
        path += [deformation.values(each) for each in result.path]
        if number < count and (result.status == "blocked" or number % CALLS == 0):
            scene.write(deformation.values(result.controls))
            deformation.set_jacobian(scene.jacobian())
    settled = session.settle()
    path += [deformation.values(each) for each in settled.path]
    _show_last_verified(scene, session, path, excluded)
    status = settled.status if settled.status != "unchanged" else result.status
    if np.array_equal(scene.written, scene.start) and status != "unchanged":
        status = "blocked"
    return replace(result, status=status, blocking=result.blocking or settled.blocking)


def _open_session(
    scene: _MorphedScene, deformation: stiv.ScalarDeformation, weights: Floats
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
    scene: _MorphedScene,
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


def _show_last_verified(
    scene: _MorphedScene, session: stiv.EditSession, path: Sequence[Floats], excluded: Exclusions
) -> None:
    """Write the last values of a path that pass the test of Blender's evaluation. Raises InputError if none do."""
    verifier = Verifier(scene.assembly, session.is_step_free, scene.settings.threads, excluded)
    message = ""
    for values in reversed(path):
        accepted = scene.evaluate(values)
        if accepted is None:
            continue
        verification = verifier.verify(bpy.context, accepted)
        if verification.passed or values is path[0]:
            return
        message = message or verification.message
    raise InputError(message or "the shape cannot be evaluated")
