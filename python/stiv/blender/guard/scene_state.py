# SPDX-License-Identifier: GPL-3.0-or-later
"""All that a user may have changed by hand, as plain values: to tell what a tool did, and to put it back bit by bit."""

import zlib
from collections.abc import Mapping
from dataclasses import dataclass

import bpy
import numpy as np

from stiv.blender.controls.cage import CageWriter, read_cage
from stiv.blender.controls.lattice_points import LatticeWriter, read_points
from stiv.blender.controls.object_transform import ROTATION_PROPERTIES
from stiv.blender.guard.posture import Posture, read_posture
from stiv.blender.scene.arrays import Floats, Singles, as_matrix
from stiv.blender.scene.evaluated_scene import is_visible
from stiv.blender.scene.references import ObjectReference


@dataclass(frozen=True)
class ObjectState:
    """An object as it was.

    Attributes:
        reference: which object.
        parent: session number of its parent, 0 for none.
        rotation_property: name of the property that holds its rotation.
        location, rotation, scale: its own properties.
        world: world matrix, (4, 4).
        points: local positions of cage vertices or lattice points, (m, 3); None for other types.
        connectivity: checksum of which vertices are joined; 0 for what is no mesh.
        posture: its pose and the values of its shape keys.
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
    posture: Posture

    @property
    def kind(self) -> tuple[int, str, int, int]:
        """What must be the same for two states of an object to be joined by a motion of its controls."""
        return self.parent, self.rotation_property, -1 if self.points is None else len(self.points), self.connectivity

    @property
    def placement(self) -> tuple[tuple[float, ...], ...]:
        """Location, rotation and scale."""
        return self.location, self.rotation, self.scale

    def has_points_of(self, other: "ObjectState") -> bool:
        """Are the vertices or points where those of another state of the object are, to the last bit?"""
        if self.points is None or other.points is None:
            return self.points is other.points
        return np.array_equal(self.points, other.points)

    def restore_placement(self) -> None:
        """Write location, rotation and scale back. Raises SceneChangedError."""
        ob = self.reference.find()
        ob.location = self.location
        setattr(ob, self.rotation_property, self.rotation)
        ob.scale = self.scale

    def restore_points(self) -> None:
        """Write vertices or lattice points back, if there are any. Raises SceneChangedError."""
        if self.points is None:
            return
        ob = self.reference.find()
        writer = CageWriter if ob.type == "MESH" else LatticeWriter
        writer(self.reference, ob.mode, self.world, self.points).restore()


SceneState = Mapping[int, ObjectState]
"""States of all visible objects by session number."""


def read_state(context: bpy.types.Context) -> SceneState:
    """All visible objects as they are now."""
    context.view_layer.update()
    objects = [ob for ob in context.view_layer.objects if is_visible(context, ob)]
    return {ob.session_uid: read_object(ob) for ob in objects}


def read_object(ob: bpy.types.Object) -> ObjectState:
    """One object as it is now."""
    if ob.type == "MESH" and ob.mode == "EDIT":
        ob.update_from_editmode()
    rotation = ROTATION_PROPERTIES.get(ob.rotation_mode, "rotation_euler")
    return ObjectState(
        ObjectReference.of(ob), 0 if ob.parent is None else ob.parent.session_uid, rotation, tuple(ob.location),
        tuple(getattr(ob, rotation)), tuple(ob.scale), as_matrix(ob.matrix_world), _points(ob), _connectivity(ob),
        read_posture(ob),
    )  # fmt: skip


def _points(ob: bpy.types.Object) -> Singles | None:
    if ob.type == "MESH":
        return read_cage(ob)
    return read_points(ob.data) if ob.type == "LATTICE" else None


def _connectivity(ob: bpy.types.Object) -> int:
    if ob.type != "MESH":
        return 0
    checksum = 0
    for collection, attribute, width in ((ob.data.loops, "vertex_index", 1), (ob.data.edges, "vertices", 2)):
        values = np.empty(len(collection) * width, np.int32)
        collection.foreach_get(attribute, values)
        checksum = zlib.crc32(values.tobytes(), checksum)
    return checksum
