# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface of a curve as a deformation of its points: weights where it is linear, Blender's evaluation elsewhere."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np
from mathutils.kdtree import KDTree

import stiv
from stiv import InputError
from stiv.blender.controls.points import to_stored
from stiv.blender.scene.arrays import Floats, Indices, Singles, transform_points
from stiv.blender.scene.curve_reading import spline_places, write_curve_points
from stiv.blender.scene.modifier_stack import modifier_error
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.stack_twin import StackTwin, kept_twin, kept_twins

TRIALS = (1e-3, 0.1, 1.0)  # random moves of the points, in sizes of the curve
ROUNDING = 3e-6  # of the size: difference between two linear results in single precision
PROBE = np.array([0.36, 0.48, 0.8])  # direction of the moves that measure weights
STEPS = {"linear": 4.0, "observed": 1e-2}  # of these moves, in sizes
DISTANT = 24, 12  # points along a curve, handles included, and of a surface: no vertex follows two so far apart
OTHER_SPLINE = np.array([10**6, 1, 1])  # factors of places: points of other splines are far away
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
    with kept_twins():
        observer = _CurveObserver(ob, scene, frame, local, evaluations)
        random = np.random.default_rng(0)
        moves = [each * observer.size * random.uniform(-1, 1, local.shape) for each in TRIALS]
        trials = [observer.moved(move) for move in moves]
        if trials[0] is None:
            raise _topology_error(ob)
        weights = observer.linear_weights()
        if all(observer.agrees(trial, weights, move) for trial, move in zip(trials, moves, strict=True)):
            return observer.linear(weights)
        return stiv.observed(observer.evaluate, observer.mean_weights())


def _topology_error(ob: bpy.types.Object) -> InputError:
    active = [modifier for modifier in ob.modifiers if modifier.show_viewport or modifier.show_render]
    if active:
        return modifier_error(ob, active[0].name, "changes topology")
    return InputError(f"{ob.name}: its fill changes its faces; convert it to a mesh")


class _CurveObserver:
    """Blender's evaluation of a curve, apart from the deformation that holds it: there must be no cycle."""

    def __init__(
        self, ob: bpy.types.Object, scene: bpy.types.Scene, frame: Floats, local: Singles, evaluations: Sequence[str]
    ) -> None:
        self._reference, self._scene, self._evaluations = ObjectReference.of(ob), scene.name, tuple(evaluations)
        self._frame, self._local = frame, local
        self._places = spline_places(ob.data)
        self.size = float(np.ptp(local, axis=0).max(initial=0.0)) or 1.0
        self._start = [twin.evaluate(local) for twin in self._twins()]

    def _twins(self) -> list[StackTwin]:
        """Twins for all evaluations. Only inside `kept_twins`."""
        return [kept_twin((self._reference, each), partial(self._make_twin, each)) for each in self._evaluations]

    def _make_twin(self, evaluation: str) -> _CurveTwin:
        return _CurveTwin(self._reference.find(), bpy.data.scenes[self._scene], evaluation)

    def evaluate(self, controls: Floats) -> Floats | None:
        """World positions, (n, 3), of all evaluations; None where the faces differ from those at the start."""
        local = to_stored(self._frame, controls, self._local)
        with kept_twins():
            points = self.moved(local.astype(np.float64) - self._local)
        return None if points is None else transform_points(self._frame, points)

    def moved(self, move: Floats) -> Floats | None:
        """Local positions, (n, 3), after a move of the points, (m, 3). Only inside `kept_twins`.

        None where the faces differ, or a position is beyond single precision.
        """
        shown = [twin.evaluate((self._local + move).astype(np.float32)) for twin in self._twins()]
        if not all(now.has_topology_of(start) for now, start in zip(shown, self._start, strict=True)):
            return None
        positions = np.concatenate([each.positions for each in shown])
        return positions.astype(np.float64) if np.isfinite(positions).all() else None

    def linear_weights(self) -> stiv.Weights:
        """Weights of the points, (n, m), if the surface is linear: each evaluation moves three, along one axis each."""
        columns = []
        for first in range(0, len(self._local), 3):
            chosen = np.arange(first, min(first + 3, len(self._local)), dtype=np.int32)
            change = self._change(chosen, np.eye(3)[: len(chosen)] * STEPS["linear"] * self.size)
            columns += [
                _Column.of(change[:, axis] / (STEPS["linear"] * self.size), LEAST["linear"])
                for axis in range(len(chosen))
            ]
        return _weights_of(columns, len(self.start()))

    def mean_weights(self) -> stiv.Weights:
        """Weights of the points, (n, m), near the start, from small moves of points that are far apart."""
        step, anchors = STEPS["observed"] * self.size, self._anchors()
        columns = [_Column.of(np.empty(0), 0.0)] * len(self._local)
        places = self._places * OTHER_SPLINE
        for group in _distant_points(self._places):
            change = self._change(group, step * PROBE) @ PROBE / step
            nearest = group[np.abs(places[anchors][:, None] - places[group]).sum(axis=2).argmin(axis=1)]
            for number in group:
                columns[number] = _Column.of(np.where(nearest == number, change, 0.0), LEAST["observed"])
        return _weights_of(columns, len(anchors))

    def _anchors(self) -> Indices:
        """The point that is closest to each vertex at the start, (n,)."""
        tree = KDTree(len(self._local))
        for number, point in enumerate(self._local.tolist()):
            tree.insert(point, number)
        tree.balance()
        return np.array([tree.find(point)[1] for point in self.start().tolist()], np.int32)

    def _change(self, chosen: Indices, moves: Floats) -> Floats:
        """Change of the surface, (n, 3), by moves of some points; none where the faces differ."""
        move = np.zeros(self._local.shape)
        move[chosen] = moves
        start = self.start()
        moved = self.moved(move)
        return np.zeros_like(start) if moved is None else moved - start

    def start(self) -> Floats:
        """Local positions at the start, (n, 3)."""
        return np.concatenate([each.positions for each in self._start]).astype(np.float64)

    def linear(self, weights: stiv.Weights) -> stiv.Deformation:
        """The surface by weights, from world positions of the points."""
        controls = transform_points(self._frame, self._local)
        start = transform_points(self._frame, self.start())
        return stiv.linear(weights, start - stiv.linear(weights).surface(controls))

    def agrees(self, shown: Floats | None, weights: stiv.Weights, move: Floats) -> bool:
        """Do the weights predict the positions after a move?"""
        if shown is None:
            return False
        return bool(
            np.abs(self.start() + stiv.linear(weights).surface(move) - shown).max(initial=0.0) <= ROUNDING * self.size
        )


def _distant_points(places: Indices) -> list[Indices]:
    """Groups of points that are far apart on their spline, from the places of all points, (m, 3)."""
    apart = DISTANT[int(places[:, 2].any())]
    _, group = np.unique(places[:, 1:] % apart, axis=0, return_inverse=True)
    return [np.flatnonzero(group.ravel() == number).astype(np.int32) for number in range(group.max(initial=-1) + 1)]


@dataclass(frozen=True)
class _Column:
    """The weights of one point: rows, (k,), and values, (k,)."""

    rows: Indices
    values: Floats

    @classmethod
    def of(cls, weights: Floats, least: float) -> _Column:
        """From the weights of all rows, (n,); those below `least` are left out."""
        rows = np.flatnonzero(np.abs(weights) >= least).astype(np.int32)
        return cls(rows, weights[rows])


def _weights_of(columns: Sequence[_Column], count: int) -> stiv.Weights:
    """Weights, (count, m), from their columns."""
    rows = np.concatenate([each.rows for each in columns])
    values = np.concatenate([each.values for each in columns])
    points = np.repeat(np.arange(len(columns), dtype=np.int32), [len(each.rows) for each in columns])
    order = np.argsort(rows, kind="stable")
    starts = np.cumsum([0, *np.bincount(rows, minlength=count)]).astype(np.int32)
    return stiv.Weights(starts, points[order], values[order], (count, len(columns)))
