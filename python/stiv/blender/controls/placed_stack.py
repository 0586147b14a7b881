# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformation of objects that are moved, rotated or scaled below modifiers that refer to other objects, which stay;
and of objects that follow moved ones.

Blender evaluates them on hidden copies in other places.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import mathutils
import numpy as np

import stiv
from stiv.blender.controls.placement_motion import PlacementMotion
from stiv.blender.scene.arrays import Floats, as_matrix, transform_points
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.evaluation_copies import EvaluationCopies
from stiv.blender.scene.followers import between
from stiv.blender.scene.mesh_reading import evaluated_mesh, read_corners, read_positions
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.stack_twin import EvaluatedStack, different_objects, kept_twin, kept_twins

STEP = 1e-3  # of the differences for a Jacobian: in sizes of the surface, and in radians or factors


class PlacedStack:
    """The surfaces of a rigid group from its centre and its rotation vector or scale factors, (2, 3).

    Attributes:
        deformation: infeasible where the topology of a mesh differs from that at the start.
    """

    def __init__(
        self,
        meshes: Sequence[VisibleMesh],
        movers: Sequence[tuple[ObjectReference, ...]],
        controls: Floats,
        motion: PlacementMotion,
    ) -> None:
        """movers: for each mesh, the moved objects on whose place its shape depends, perhaps itself; () if it is rigid.

        controls: at the start, (2, 3).
        """
        self._placements = _Placements(meshes, movers, controls, motion)
        jacobian = self._placements.jacobian()
        self.deformation = stiv.observed(self._placements.evaluate, jacobian, motion.rotation_rows)

    def renew_jacobian(self) -> None:
        """Measure the Jacobian at the last evaluation."""
        self.deformation.set_jacobian(self._placements.jacobian())


@dataclass(frozen=True, eq=False)
class _PlacedMesh:
    """A mesh with its copy, and copies of its movers, elsewhere."""

    reference: ObjectReference
    evaluation: str
    movers: tuple[ObjectReference, ...]
    starts: tuple[Floats, ...]  # world matrices of the movers, (4, 4)

    @classmethod
    def of(cls, mesh: VisibleMesh, movers: tuple[ObjectReference, ...]) -> _PlacedMesh:
        """Take the present places of the movers."""
        starts = [mesh.matrix if each == mesh.owner else as_matrix(each.find().matrix_world) for each in movers]
        return cls(mesh.owner, mesh.read_from, movers, tuple(starts))

    def evaluate(self, motion: PlacementMotion, controls: Floats) -> tuple[EvaluatedStack, Floats]:
        """The evaluation after a motion since the start, and its world matrix. Only inside `kept_twins`."""
        twin = kept_twin(self, lambda: _PlacedTwin(self.reference, self.evaluation, self.movers))
        if self.reference in self.movers:
            return twin.evaluate([motion.matrix(controls) @ start for start in self.starts])
        return twin.evaluate([motion.matrix_of(controls, start) @ start for start in self.starts])


class _Placements:
    """The surfaces of a group. Apart from `PlacedStack`, as the core holds `evaluate`: no cycle of references."""

    def __init__(
        self,
        meshes: Sequence[VisibleMesh],
        movers: Sequence[tuple[ObjectReference, ...]],
        controls: Floats,
        motion: PlacementMotion,
    ) -> None:
        self._motion, self._last = motion, controls
        self._rest = [each.world() for each in meshes]
        self._bent = [
            _PlacedMesh.of(each, movers_of_it) if movers_of_it else None
            for each, movers_of_it in zip(meshes, movers, strict=True)
        ]
        with kept_twins():
            self._start = [None if each is None else each.evaluate(motion, controls)[0] for each in self._bent]
        self._size = float(np.ptp(np.concatenate(self._rest), axis=0).max(initial=0.0)) or 1.0

    def evaluate(self, controls: Floats) -> Floats | None:
        """World positions, (n, 3), from the controls; None if the topology of a mesh differs."""
        motion = self._motion.matrix(controls)  # of the rigid meshes
        found = []
        with kept_twins():
            for bent, start, rest in zip(self._bent, self._start, self._rest, strict=True):
                if bent is None or start is None:
                    found.append(transform_points(motion, rest))
                    continue
                shown, matrix = bent.evaluate(self._motion, controls)
                if not shown.corresponds_to(start) or not np.isfinite(shown.positions).all():
                    return None
                found.append(transform_points(matrix, shown.positions))
        self._last = controls
        return np.concatenate(found)

    def jacobian(self) -> Floats:
        """Central differences at the last evaluation, (n, 3, 2, 3); 0 along controls where the topology changes."""
        last = self._last
        result = np.zeros((sum(map(len, self._rest)), 3, 2, 3))
        with kept_twins():
            for row, step in enumerate((STEP * self._size, STEP)):
                for axis in range(3):
                    move = np.zeros((2, 3))
                    move[row, axis] = step
                    ends = [self.evaluate(last + sign * move) for sign in (1, -1)]
                    if ends[0] is not None and ends[1] is not None:
                        result[:, :, row, axis] = (ends[0] - ends[1]) / (2 * step)
        self._last = last
        return result


class _PlacedTwin:
    """A copy of an object, alone in a scene of its own, with copies of its movers and of those between."""

    def __init__(self, reference: ObjectReference, evaluation: str, movers: Sequence[ObjectReference]) -> None:
        ob, scene = reference.find(), bpy.context.scene
        moved = [] if reference in movers else between(ob, {each.session_uid for each in movers})
        self.copies = EvaluationCopies(scene, evaluation)
        try:
            copied = dict.fromkeys([ob, *different_objects(ob, scene, evaluation), *moved])
            self.copies.fill([*copied], lambda other: other == ob)
        except BaseException:
            self.copies.remove()
            raise
        self._ob = self.copies.copy_of(reference)
        numbers = {each.session_uid for each in copied}
        self._movers = [self.copies.copy_of(each) if each.session_uid in numbers else None for each in movers]

    def evaluate(self, places: Sequence[Floats]) -> tuple[EvaluatedStack, Floats]:
        """The evaluation with the movers at world matrices, (4, 4) each, and the evaluated matrix."""
        for mover, place in zip(self._movers, places, strict=True):
            if mover is not None:
                mover.matrix_world = mathutils.Matrix(place.tolist())
        graph = self.copies.depsgraph
        graph.update()
        shown = self._ob.evaluated_get(graph)
        with evaluated_mesh(shown) as mesh:
            return EvaluatedStack(read_positions(mesh), *read_corners(mesh)), as_matrix(shown.matrix_world)
