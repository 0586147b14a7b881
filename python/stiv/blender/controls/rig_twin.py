# SPDX-License-Identifier: GPL-3.0-or-later
"""Hidden copies of rigs and their followers, which Blender evaluates in any pose."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from stiv.blender.controls.bone_channels import BoneChannels
from stiv.blender.scene.arrays import Floats, Indices, as_matrix, transform_points
from stiv.blender.scene.evaluation_copies import EvaluationCopies
from stiv.blender.scene.mesh_reading import evaluated_mesh, read_corner_vertices, read_positions
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.stack_twin import EvaluatedStack


@dataclass(frozen=True)
class PosedMesh:
    """A mesh and its matrix in a pose."""

    stack: EvaluatedStack
    matrix: Floats

    def is_like(self, start: PosedMesh) -> bool:
        """Has it the topology of the start, and finite positions?"""
        return self.stack.has_topology_of(start.stack) and bool(np.isfinite(self.stack.positions).all())

    def world(self) -> Floats:
        """World positions, (n, 3)."""
        if np.array_equal(self.matrix, np.eye(4)):
            return self.stack.positions.astype(np.float64)
        return transform_points(self.matrix, self.stack.positions)


def _count(items: bpy.types.bpy_prop_collection) -> Indices:
    return np.array([len(items)], np.int32)


NONE = np.empty(0, np.int32)
MISSING = PosedMesh(EvaluatedStack(np.empty((0, 3), np.float32), NONE, NONE), np.eye(4))


class RigTwin:
    """Copies of rigs and of all objects that move with them, in a scene of their own."""

    def __init__(
        self,
        rigs: Sequence[ObjectReference],
        followers: frozenset[str],
        shown: set[ObjectReference],
        evaluation: str,
        worn: frozenset[str] = frozenset(),
    ) -> None:
        """shown: the owners of the meshes that are read. worn: names of the objects whose data is written."""
        scene = bpy.context.scene
        objects = [ob for ob in scene.objects if ob.name in followers]
        own_data = [ob for ob in objects if has_drivers(ob.data) or has_drivers(getattr(ob.data, "shape_keys", None))]
        own_data += [ob for ob in objects if ob.name in worn and ob not in own_data]
        wanted = {each.session_uid for each in (*shown, *rigs)}
        self.copies = EvaluationCopies(scene, evaluation, own_data)
        try:
            self.copies.fill(objects, lambda ob: ob.session_uid in wanted)
            self._rigs = {each.session_uid: self.copies.copy_of(each) for each in rigs}
            self._worn = {ob.name: self.copies.copy_of(ObjectReference.of(ob)) for ob in objects if ob.name in worn}
            self._shown = {each.session_uid for each in shown}
        except BaseException:
            self.copies.remove()
            raise

    def evaluate(self, pose: Iterator[tuple[BoneChannels, Floats]]) -> Iterator[tuple[ObjectReference, PosedMesh]]:
        """The meshes in a pose, with their owners."""
        for bone, channels in pose:
            bone.write(channels, self._rigs[bone.rig.session_uid].pose.bones[bone.name])
        graph = self.copies.depsgraph
        graph.update()
        for instance in graph.object_instances:
            if instance.object.type != "MESH" or not (instance.show_self or instance.is_instance):
                continue
            copy = instance.parent.original if instance.is_instance else instance.object.original
            owner = self.copies.owner(copy)
            if owner.session_uid in self._shown:
                with evaluated_mesh(instance.object) as mesh:
                    stack = EvaluatedStack(read_positions(mesh), read_corner_vertices(mesh), _count(mesh.polygons))
                yield ObjectReference.of(owner), PosedMesh(stack, as_matrix(instance.matrix_world))

    def copy_of(self, name: str) -> bpy.types.Object:
        """The copy of an object whose data is written."""
        return self._worn[name]

    def local_matrices(self) -> dict[tuple[int, str], Floats]:
        """The matrix of each bone relative to its parent, by rig and name."""
        graph, found = self.copies.depsgraph, {}
        for number, rig in self._rigs.items():
            for bone in rig.evaluated_get(graph).pose.bones:
                if bone.parent is not None:
                    found[number, bone.name] = as_matrix(bone.parent.matrix.inverted_safe() @ bone.matrix)
        return found

    def weights(self, owner: ObjectReference, count: int) -> tuple[list[str], Floats]:
        """Names of the bones that have vertex groups, and their weights, (n, g), at n evaluated vertices."""
        bones = {bone.name for rig in self._rigs.values() for bone in rig.data.bones}
        return skin_weights(self.copies.evaluated(owner), bones, count)


def skin_weights(shown: bpy.types.Object, bones: Collection[str], count: int) -> tuple[list[str], Floats]:
    """Names of the bones that have vertex groups, and their weights, (n, g), at n vertices of an evaluated object.

    An object without such groups has the weight 1 for the bone that is its parent, or that of one of its parents.
    """
    names = [group.name for group in shown.vertex_groups if group.name in bones] if shown.type == "MESH" else []
    if not names and (carrier := _carrier(shown, bones)):
        return [carrier], np.ones((count, 1))
    result = np.zeros((count, len(names)))
    column = {shown.vertex_groups[name].index: k for k, name in enumerate(names)}
    with evaluated_mesh(shown) as mesh:
        if names and len(mesh.vertices) == count:
            for row, vertex in enumerate(mesh.vertices):
                for group in vertex.groups:
                    if group.group in column:
                        result[row, column[group.group]] = group.weight
    return names, result


def _carrier(shown: bpy.types.Object, bones: Collection[str]) -> str:
    """The bone that carries an object; "" for none."""
    ob: bpy.types.Object | None = shown
    while ob is not None:
        if ob.parent_type == "BONE" and ob.parent_bone in bones:
            return str(ob.parent_bone)
        ob = ob.parent
    return ""


def has_drivers(owner: bpy.types.ID | None) -> bool:
    """Has an ID drivers?"""
    animation = getattr(owner, "animation_data", None)
    return animation is not None and len(animation.drivers) > 0
