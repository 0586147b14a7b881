# SPDX-License-Identifier: GPL-3.0-or-later
"""The modifiers of a mesh that Blender itself evaluates during an edit, on a hidden copy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

import stiv
from stiv.blender.controls.affine_stack import (
    TRIALS,
    AffineMap,
    ExactMap,
    Rows,
    find_affine_map,
    find_smoothing_map,
    may_be_affine,
)
from stiv.blender.controls.held_vertices import HeldVertices
from stiv.blender.controls.points import to_single, to_stored
from stiv.blender.controls.stack_jacobian import find_anchors, find_frames
from stiv.blender.controls.stack_refusals import LARGE, SMALL, check_diagonals, check_twin
from stiv.blender.controls.subdivision import subdivide
from stiv.blender.scene.arrays import Floats, Singles, as_matrix, transform_points
from stiv.blender.scene.evaluations import is_active, modifier_signature
from stiv.blender.scene.mesh_reading import read_edges
from stiv.blender.scene.modifier_stack import StackEnd, SubdivisionStage, read_end
from stiv.blender.scene.position_test import keep_positions, random_moves
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.stack_twin import EvaluatedStack, StackTwin, different_objects, kept_twin, kept_twins
from stiv.task import Steps, Turns, run

STEP = 0.03  # of the differences for a Jacobian, in lengths of an edge
FURTHEST = 1e6  # motion that is evaluated, in sizes of the mesh: beyond it, single precision loses the shape


@dataclass(frozen=True)
class BlockSettings:
    """The modifiers of a block.

    Attributes:
        reference: the object.
        evaluation: one that shows the block.
        end: the modifiers after it, switched off on the twin.
        modifiers: those of the block, with the settings that differ between evaluations, and names of objects that do.
    """

    reference: ObjectReference
    evaluation: str
    end: StackEnd
    modifiers: tuple[object, ...]

    @classmethod
    def read(cls, ob: bpy.types.Object, scene: bpy.types.Scene, evaluation: str) -> BlockSettings:
        """Read the stack of an object in an evaluation."""
        end = read_end(ob, scene, evaluation)
        modifiers = [
            (each.name, modifier_signature(each, ob, scene, evaluation))
            for each in ob.modifiers
            if is_active(each, ob, evaluation) and each.name not in end.modifiers
        ]
        others = [each.name for each in different_objects(ob, scene, evaluation)]
        return cls(ObjectReference.of(ob), evaluation, end, (*modifiers, *others))

    @property
    def shown_by(self) -> tuple[object, ...]:
        """Equal for evaluations that show the same."""
        return self.reference, self.end, self.modifiers

    def open_twin(self) -> StackTwin:
        """The twin, which shows the block alone. Only inside `kept_twins`."""
        return kept_twin(self, self._make_twin)

    def _make_twin(self) -> StackTwin:
        twin = StackTwin(self.reference.find(), bpy.context.scene, self.evaluation)
        twin.show_modifiers(self.end.modifiers, False)
        return twin


class StackBlock:
    """Blender's evaluation of a block, from world positions of the vertices, (m, 3).

    It is a function of these alone: the twin may be removed and made again at any time.

    Attributes:
        controls: number of vertices of the mesh.
        count: number of evaluated vertices.
        anchors: the vertex that each of them follows, (n,).
        exact: the same function, if it is affine; None otherwise.
    """

    def __init__(self, settings: BlockSettings, frame: Floats, positions: Floats, held: HeldVertices) -> None:
        """Evaluate the block at positions, (m, 3), in the frame of the edited object, (4, 4). Only inside `kept_twins`.

        Raises InputError if the topology changes with small moves, or the surface does not follow the vertices.
        """
        run(self._read_steps(settings, frame, positions, held, Turns()))

    @classmethod
    def read_steps(
        cls, settings: BlockSettings, frame: Floats, positions: Floats, held: HeldVertices, turns: Turns
    ) -> Steps[StackBlock]:
        """Steps of the constructor, which take turns between evaluations."""
        block = cls.__new__(cls)
        yield from block._read_steps(settings, frame, positions, held, turns)
        return block

    def _read_steps(
        self, settings: BlockSettings, frame: Floats, positions: Floats, held: HeldVertices, turns: Turns
    ) -> Steps[None]:
        self._settings, self._frame, self._held, self._rest = settings, frame, held, positions
        ob, twin = settings.reference.find(), settings.open_twin()
        self._shown_frame = as_matrix(ob.matrix_world)
        self._local = to_single(frame, positions)
        self.controls = len(positions)
        self._step = STEP * _edge_length(ob, positions)
        self._furthest = FURTHEST * (float(np.ptp(positions, axis=0).max(initial=0.0)) or 1.0)
        start, *moves = [
            self._stored(transform_points(frame, each)) for each in random_moves(self._local, (*SMALL, LARGE))
        ]
        yield from turns.take()
        check_twin(ob, twin, [start, *moves[:-1]], self._agree)
        yield from turns.take()
        ob = settings.reference.find()
        check_diagonals(ob, twin, [start, moves[-1]], self._agree)
        self._start = twin.evaluate(self._local)
        yield from turns.take()
        ob = settings.reference.find()
        self.count = len(self._start.positions)
        anchors = find_anchors(twin, self._start, self._local, STEP * _edge_length(ob, self._local))
        self.anchors = anchors if held.leaders is None else held.leaders[anchors]
        self._last = positions
        self._frames = np.broadcast_to(np.eye(3), (self.count, 3, 3))
        yield from turns.take()
        block = self._modifiers(settings.reference.find())
        self.exact = self._find_exact_map(block)
        self._is_computed = all(each.type != "WELD" for each in block)

    @property
    def end_modifiers(self) -> tuple[str, ...]:
        """Names of the modifiers after the block."""
        return self._settings.end.modifiers

    def evaluate(self, positions: Floats) -> Floats | None:
        """World positions of the evaluated vertices, (n, 3); None if their topology differs from that at the start."""
        if np.abs(positions - self._rest).max(initial=0.0) > self._furthest:
            return None
        if self._is_computed and self.exact is not None:
            is_apart = self._held.keeps_apart(positions, self._rest, self._frame)
            return self.exact.evaluate(positions) if is_apart else None
        points = self._observe(positions)
        if points is not None:
            self._last = positions
        return points

    def frames(self) -> Floats:
        """How each evaluated vertex moves with all vertices, (n, 3, 3): at the last positions, if it is known there."""
        if isinstance(self.exact, AffineMap):
            return self.exact.frames
        with kept_twins():
            found = find_frames(self._observe, self._last, self._step)
        self._frames = self._frames if found is None else found
        return self._frames

    def rows(self) -> Rows:
        """The Jacobian: exact, or by frames."""
        if self.exact is not None:
            return self.exact.rows()
        return np.arange(self.count + 1, dtype=np.int32), self.anchors, self.frames()

    def end_weights(self, subdivision: SubdivisionStage) -> stiv.Weights:
        """Weights of a subdivision of the evaluated mesh. Only inside `kept_twins`."""
        twin = self._settings.open_twin()
        twin.write(self._local)
        with twin.evaluated() as mesh:
            return stiv.linear_weights(subdivide(mesh, subdivision))[0]

    def _observe(self, positions: Floats) -> Floats | None:
        with kept_twins():
            shown = self._settings.open_twin().evaluate(self._stored(positions))
        if not self._agree(shown, self._start) or not np.isfinite(shown.positions).all():
            return None
        return transform_points(self._shown_frame, shown.positions)

    def _agree(self, one: EvaluatedStack, other: EvaluatedStack) -> bool:
        """Have two evaluations the same topology? Diagonals matter only to a subdivision."""
        if self._settings.end.subdivision is not None:
            return one.has_topology_of(other)
        return one.corresponds_to(other)

    def _modifiers(self, ob: bpy.types.Object) -> list[bpy.types.Modifier]:
        """The modifiers of the block."""
        evaluation = self._settings.evaluation
        return [
            each for each in ob.modifiers if is_active(each, ob, evaluation) and each.name not in self.end_modifiers
        ]

    def _find_exact_map(self, block: Sequence[bpy.types.Modifier]) -> ExactMap | None:
        ob, evaluation = self._settings.reference.find(), self._settings.evaluation
        trials = [transform_points(self._frame, each) for each in random_moves(self._local, TRIALS)]
        if smoothing := find_smoothing_map(self._observe, self._rest, ob, block, trials):
            return smoothing
        others = [each.name for number, each in enumerate(block) if not may_be_affine(each, number == 0)]
        if (block and len(others) == len(block)) or (
            others and not keep_positions(ob, bpy.context.scene, evaluation, others)
        ):
            return None
        return find_affine_map(self._observe, self._rest, self.anchors, trials)

    def _stored(self, positions: Floats) -> Singles:
        """Local positions, (m, 3), as they are written."""
        return to_stored(self._frame, self._held.hold(positions, self._rest, self._frame), self._local)


def _edge_length(ob: bpy.types.Object, points: Floats | Singles) -> float:
    """Median length of the edges; the size of a mesh without edges."""
    ends = points[read_edges(ob.data)]
    lengths = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1)
    return float(np.median(lengths[lengths > 0])) if (lengths > 0).any() else float(np.ptp(points) or 1.0)
