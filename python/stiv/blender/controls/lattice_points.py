# SPDX-License-Identifier: GPL-3.0-or-later
"""The points of a lattice as controls of every visible mesh that it deforms."""

from dataclasses import dataclass

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.control_set import Part
from stiv.blender.controls.control_weights import axes_of_weights, control_weights
from stiv.blender.controls.editable import check_data
from stiv.blender.controls.movers import Mover
from stiv.blender.controls.points import PointGoal, point_weights, stored
from stiv.blender.scene.arrays import Flags, Floats, Singles, as_matrix, read_collection, transform_points
from stiv.blender.scene.errors import SceneChangedError
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings


def is_undeformed(lattice: bpy.types.Lattice) -> bool:
    """Are all points at rest, to the last bit? Such a lattice changes nothing."""
    return bool(np.array_equal(read_points(lattice), read_rest_points(lattice)))


def read_points(lattice: bpy.types.Lattice) -> Singles:
    """Deformed points, (m, 3), in the lattice's frame."""
    return read_collection(lattice.points, "co_deform", 3, np.float32)


def read_rest_points(lattice: bpy.types.Lattice) -> Singles:
    """Points at rest, (m, 3), in the lattice's frame.

    In Edit Mode the rest positions that Blender gives are nonsense; those of a copy, which is in no mode, are right.
    They do not follow from the size alone: a lattice whose resolution was changed keeps its extents.
    """
    if not lattice.is_editmode:
        return read_collection(lattice.points, "co", 3, np.float32)
    copy = lattice.copy()
    try:
        return read_collection(copy.points, "co", 3, np.float32)
    finally:
        bpy.data.lattices.remove(copy)


def lattice_part(
    mover: Mover, surfaces: tuple[int, ...], deformation: stiv.Deformation, settings: EditSettings
) -> Part:
    """A lattice as a part; `deformation` is that of all meshes it deforms, side by side."""
    ob = mover.reference.find()
    if ob.mode == "EDIT":
        ob.update_from_editmode()
    frame, local = as_matrix(ob.matrix_world), read_points(ob.data)
    controls = transform_points(frame, local)
    found = control_weights(ob, settings)
    given = found.given
    selected = _selected(ob, mover) & found.movable
    others = settings.weight(False) if mover.selected else 1.0
    weights = point_weights(selected, settings.weight(True), others, given)
    return Part(
        (ob.name,), "lattice", surfaces, deformation, controls, weights, given, frame,
        PointGoal(selected, controls, None, None if ob.mode == "EDIT" else frame[:3, 3], found.movable, found.pinned),
        LatticeWriter(mover.reference, ob.mode, frame, local, found.kept_coordinates),
        weight_axes=axes_of_weights(given, found.directions),
    )  # fmt: skip


def check_lattice(ob: bpy.types.Object) -> None:
    """Refuse a lattice whose points cannot be written, or would not show. Raises InputError."""
    check_data(ob)
    if ob.data.shape_keys is not None:
        raise InputError(f'object "{ob.name}": its shape keys hide changes of the lattice; apply or remove them')
    for modifier in ob.modifiers:
        if modifier.show_viewport:
            raise InputError(
                f'object "{ob.name}", modifier "{modifier.name}": deforms the lattice; apply it or disable it'
            )


def _selected(ob: bpy.types.Object, mover: Mover) -> Flags:
    if ob.mode == "EDIT":
        return np.array([point.select for point in ob.data.points], np.bool_)
    return np.full(len(ob.data.points), mover.selected)


@dataclass(frozen=True)
class LatticeWriter:
    """Writes lattice points; in Edit Mode Blender passes them on to the lattice being edited.

    `kept` are the local coordinates, (m, 3), that are pinned.
    """

    reference: ObjectReference
    mode: str
    frame: Floats
    original: Singles
    kept: Flags | None = None

    def write(self, controls: Floats) -> None:
        """Write world positions, (m, 3)."""
        local = stored(self.frame, controls, self.original, self.kept)
        _write_local(self.reference.find_in_mode(self.mode), local)

    def restore(self) -> None:
        """Write the original positions, in whatever mode the object is by now."""
        _write_local(self.reference.find(), self.original)


def _write_local(ob: bpy.types.Object, local: Singles) -> None:
    lattice = ob.data
    if len(lattice.points) != len(local):
        raise SceneChangedError(f'object "{ob.name}" has got another number of points')
    lattice.points.foreach_set("co_deform", local.ravel())
    lattice.update_tag()
