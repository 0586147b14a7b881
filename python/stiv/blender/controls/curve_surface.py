# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface of a curve as a deformation of its points: weights where it is linear, Blender's evaluation elsewhere."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.points import to_stored
from stiv.blender.scene.arrays import Floats, Singles, transform_points
from stiv.blender.scene.curve_reading import write_curve_points
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.stack_twin import StackTwin

TRIALS = (1e-3, 0.1, 1.0)  # random moves of the points, in sizes of the curve
ROUNDING = 3e-6  # of the size: difference between two linear results in single precision
PROBE = np.array([0.36, 0.48, 0.8])  # direction of the moves that measure weights
STEPS = {"linear": 4.0, "observed": 1e-2}  # of these moves, in sizes
LEAST = {"linear": 1e-6, "observed": 1e-3}  # weights below are noise


class _CurveTwin(StackTwin):
    """A hidden copy of a curve, evaluated with any positions of its points."""

    def write(self, local: Singles) -> None:
        """Write local positions of all points, (m, 3)."""
        write_curve_points(self.ob.data, local)


def curve_surface(
    ob: bpy.types.Object, scene: bpy.types.Scene, frame: Floats, local: Singles, evaluations: Sequence[str]
) -> stiv.Deformation:
    """The surface of a curve in some evaluations, from world positions of its points, (m, 3).

    frame: (4, 4). local: its points at the start, (m, 3). Raises InputError if an edit would change its faces.
    """
    observer = _CurveObserver(ob, scene, frame, local, evaluations)
    with observer.open() as twins:
        random = np.random.default_rng(0)
        moves = [each * observer.size * random.uniform(-1, 1, local.shape) for each in TRIALS]
        trials = [observer.evaluate_in(twins, move) for move in moves]
        if trials[0] is None:
            raise InputError(f"{ob.name}: its fill changes its faces; convert it to a mesh")
        weights = observer.measure(twins, "linear")
        if all(observer.agrees(trial, weights, move) for trial, move in zip(trials, moves, strict=True)):
            return observer.linear(weights)
        return stiv.observed(observer.evaluate, observer.measure(twins, "observed"))


class _CurveObserver:
    """Blender's evaluation of a curve, apart from the deformation that holds it: there must be no cycle."""

    def __init__(
        self, ob: bpy.types.Object, scene: bpy.types.Scene, frame: Floats, local: Singles, evaluations: Sequence[str]
    ) -> None:
        self._reference, self._scene, self._evaluations = ObjectReference.of(ob), scene.name, tuple(evaluations)
        self._frame, self._local = frame, local
        self.size = float(np.ptp(local, axis=0).max(initial=0.0)) or 1.0
        with self.open() as twins:
            self._start = [twin.evaluate(local) for twin in twins]

    @contextmanager
    def open(self) -> Iterator[list[_CurveTwin]]:
        """Twins for all evaluations, removed at the end of the `with` statement."""
        twins: list[_CurveTwin] = []
        try:
            for evaluation in self._evaluations:
                twins.append(_CurveTwin(self._reference.find(), bpy.data.scenes[self._scene], evaluation))
            yield twins
        finally:
            for twin in twins:
                twin.remove()

    def evaluate(self, controls: Floats) -> Floats | None:
        """World positions, (n, 3), of all evaluations; None where the faces differ from those at the start."""
        local = to_stored(self._frame, controls, self._local)
        with self.open() as twins:
            points = self.evaluate_in(twins, local.astype(np.float64) - self._local)
        return None if points is None else transform_points(self._frame, points)

    def evaluate_in(self, twins: Sequence[_CurveTwin], move: Floats) -> Floats | None:
        """Local positions, (n, 3), after a move of the points, (m, 3)."""
        shown = [twin.evaluate((self._local + move).astype(np.float32)) for twin in twins]
        if not all(now.has_topology_of(start) for now, start in zip(shown, self._start, strict=True)):
            return None
        return np.concatenate([each.positions for each in shown]).astype(np.float64)

    def measure(self, twins: Sequence[_CurveTwin], kind: str) -> stiv.Weights:
        """Weights of the points, (n, m), from one move of each."""
        start = np.concatenate([each.positions for each in self._start]).astype(np.float64)
        step = STEPS[kind] * self.size
        columns = []
        for number in range(len(self._local)):
            move = np.zeros(self._local.shape)
            move[number] = step * PROBE
            moved = self.evaluate_in(twins, move)
            columns.append(np.zeros(len(start)) if moved is None else (moved - start) @ PROBE / step)
        whole = np.stack(columns, axis=1)
        whole[np.abs(whole) < LEAST[kind]] = 0
        rows, places = np.nonzero(whole)
        starts = np.cumsum([0, *np.bincount(rows, minlength=len(whole))]).astype(np.int32)
        return stiv.Weights(starts, places.astype(np.int32), whole[rows, places], (len(whole), len(self._local)))

    def linear(self, weights: stiv.Weights) -> stiv.Deformation:
        controls = transform_points(self._frame, self._local)
        start = np.concatenate([transform_points(self._frame, each.positions) for each in self._start])
        return stiv.linear(weights, start - stiv.linear(weights).surface(controls))

    def agrees(self, shown: Floats | None, weights: stiv.Weights, move: Floats) -> bool:
        """Do the weights predict the positions after a move?"""
        if shown is None:
            return False
        start = np.concatenate([each.positions for each in self._start])
        return bool(np.abs(start + stiv.linear(weights).surface(move) - shown).max(initial=0.0) <= ROUNDING * self.size)
