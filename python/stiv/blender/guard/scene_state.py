# SPDX-License-Identifier: GPL-3.0-or-later
"""States of a scene: all that a user can change by hand, to detect changes and to restore them exactly."""

import zlib
from collections.abc import Mapping
from dataclasses import dataclass

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.controls.cage import CageWriter
from stiv.blender.controls.curve_points import CurveWriter
from stiv.blender.controls.key_editing import KeyEditing
from stiv.blender.controls.lattice_points import LatticeWriter
from stiv.blender.controls.object_transform import ROTATION_PROPERTIES
from stiv.blender.scene.arrays import Floats, Singles, as_matrix
from stiv.blender.scene.curve_reading import read_curve_points
from stiv.blender.scene.evaluations import is_edited, is_visible
from stiv.blender.scene.lattice_reading import read_lattice_points
from stiv.blender.scene.mesh_reading import read_cage, read_corner_vertices, read_edges, read_faces
from stiv.blender.scene.references import ObjectReference, SceneChangedError


@dataclass(frozen=True)
class PoseState:
    """Pose and shape key values of an object.

    Attributes:
        bones: name, location, rotation property, rotation and scale of each pose bone.
        keys: name and value of each shape key.
    """

    bones: tuple[tuple[str, tuple[float, ...], str, tuple[float, ...], tuple[float, ...]], ...] = ()
    keys: tuple[tuple[str, float], ...] = ()

    @staticmethod
    def read(ob: bpy.types.Object) -> "PoseState":
        """Read an object; empty for objects without pose and shape keys."""
        keys = getattr(ob.data, "shape_keys", None)
        return PoseState(
            tuple(map(_read_bone, ob.pose.bones)) if ob.pose is not None else (),
            tuple((key.name, key.value) for key in keys.key_blocks) if keys is not None else (),
        )

    def restore(self, ob: bpy.types.Object) -> None:
        """Restore the pose; missing bones and keys are skipped."""
        for name, location, rotation_property, rotation, scale in self.bones:
            bone = ob.pose.bones.get(name) if ob.pose is not None else None
            if bone is not None:
                bone.location, bone.scale = location, scale
                setattr(bone, rotation_property, rotation)
        keys = getattr(ob.data, "shape_keys", None)
        for name, value in self.keys:
            key = keys.key_blocks.get(name) if keys is not None else None
            if key is not None:
                key.value = value


@dataclass(frozen=True)
class ObjectState:
    """The state of an object.

    Attributes:
        reference: the object.
        parent: session number of its parent, 0 for none.
        rotation_property: name of the property with its rotation.
        location, rotation, scale: its own properties.
        world: world matrix, (4, 4).
        points: local positions of cage vertices as shown, or of a lattice's or curve's points, (m, 3); otherwise None.
        keys: the active shape key and those that follow it; None without.
        connectivity: checksum of its faces and edges; 0 for other types than meshes.
        pose: pose and shape key values.
    """

    reference: ObjectReference
    parent: int
    rotation_property: str
    location: tuple[float, ...]
    rotation: tuple[float, ...]
    scale: tuple[float, ...]
    world: Floats
    points: Singles | None
    connectivity: int
    pose: PoseState
    keys: KeyEditing | None = None

    @property
    def kind(self) -> tuple[object, ...]:
        """Properties that must agree before an edit can lead from one state to another."""
        count = -1 if self.points is None else len(self.points)
        keys = () if self.keys is None else tuple(number for number, _ in self.keys.stored)
        return self.parent, self.rotation_property, count, self.connectivity, keys

    @property
    def placement(self) -> tuple[tuple[float, ...], ...]:
        """Location, rotation and scale."""
        return self.location, self.rotation, self.scale

    def has_same_points(self, other: "ObjectState") -> bool:
        """Do the vertices or points agree with another state exactly?"""
        if self.points is None or other.points is None:
            return self.points is other.points
        return np.array_equal(self.points, other.points)

    def restore_placement(self) -> None:
        """Restore location, rotation and scale. Raises SceneChangedError."""
        ob = self.reference.find()
        ob.location = self.location
        setattr(ob, self.rotation_property, self.rotation)
        ob.scale = self.scale

    def restore_points(self) -> None:
        """Restore vertices or points, if there are any. Raises SceneChangedError."""
        if self.points is None:
            return
        ob = self.reference.find()
        if ob.type == "MESH":
            CageWriter(self.reference, ob.mode, self.world, self.points, keys=self.keys).restore()
        else:
            make_writer = LatticeWriter if ob.type == "LATTICE" else CurveWriter
            make_writer(self.reference, ob.mode, self.world, self.points).restore()


SceneState = Mapping[int, ObjectState]
"""States of all visible objects by session number."""


def read_state(context: bpy.types.Context) -> SceneState:
    """Read all visible objects."""
    context.view_layer.update()
    objects = [ob for ob in context.view_layer.objects if is_visible(context, ob)]
    return {ob.session_uid: read_object(ob) for ob in objects}


def read_object(ob: bpy.types.Object) -> ObjectState:
    """Read one object."""
    if ob.type == "MESH" and is_edited(ob):
        ob.update_from_editmode()
    rotation = ROTATION_PROPERTIES.get(ob.rotation_mode, "rotation_euler")
    return ObjectState(
        ObjectReference.of(ob), 0 if ob.parent is None else ob.parent.session_uid, rotation, tuple(ob.location),
        tuple(getattr(ob, rotation)), tuple(ob.scale), as_matrix(ob.matrix_world), _points(ob), _connectivity(ob),
        PoseState.read(ob), KeyEditing.of(ob) if ob.type == "MESH" else None,
    )  # fmt: skip


def _points(ob: bpy.types.Object) -> Singles | None:
    if ob.type == "MESH":
        return read_cage(ob)
    if ob.type == "LATTICE":
        return read_lattice_points(ob.data)
    return read_curve_points(ob.data) if ob.type in ("CURVE", "SURFACE") else None


def _connectivity(ob: bpy.types.Object) -> int:
    if ob.type != "MESH":
        return 0
    corners = read_faces(ob.data)[0] if ob.data.is_editmode else read_corner_vertices(ob.data)
    return zlib.crc32(read_edges(ob.data).tobytes(), zlib.crc32(corners.tobytes()))


def _read_bone(bone: bpy.types.PoseBone) -> tuple[str, tuple[float, ...], str, tuple[float, ...], tuple[float, ...]]:
    rotation = ROTATION_PROPERTIES.get(bone.rotation_mode, "rotation_euler")
    return bone.name, tuple(bone.location), rotation, tuple(getattr(bone, rotation)), tuple(bone.scale)


def revert(context: bpy.types.Context, state: SceneState) -> tuple[str, ...]:
    """Restore the controls of every object in a state; returns the names of those that differed.

    New objects stay as they are, and removed ones are skipped. Raises InputError naming an object whose vertices,
    parent or rotation mode changed, before anything is changed.
    """
    differing = [former for former in state.values() if _differs(former)]
    for former in differing:
        ob = former.reference.find()
        if former.placement != (now := read_object(ob)).placement:
            former.restore_placement()
        if former.pose != now.pose:
            former.pose.restore(ob)
        if not former.has_same_points(now):
            former.restore_points()
    context.view_layer.update()
    return tuple(former.reference.name for former in differing)


def _differs(former: ObjectState) -> bool:
    try:
        now = read_object(former.reference.find())
    except SceneChangedError:  # removed meanwhile
        return False
    if now.kind != former.kind:
        raise InputError(f"{former.reference.name}: its structure has changed; use Undo instead")
    same = former.placement == now.placement and former.pose == now.pose
    return not (same and former.has_same_points(now))
