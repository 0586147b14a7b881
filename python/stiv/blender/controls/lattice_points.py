# SPDX-License-Identifier: GPL-3.0-or-later
"""The points of a lattice as controls of all visible meshes that it deforms."""

from dataclasses import dataclass

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.control_set import ControlSet, Participant
from stiv.blender.controls.control_weights import axes_of_weights, control_weights, response_weights
from stiv.blender.controls.editable import check_data
from stiv.blender.controls.points import PointGoal, to_stored
from stiv.blender.scene.arrays import Flags, Floats, Singles, as_matrix, read_collection, transform_points
from stiv.blender.scene.lattice_reading import read_lattice_points
from stiv.blender.scene.modifier_stack import modifier_error
from stiv.blender.scene.references import ObjectReference, SceneChangedError
from stiv.blender.settings import EditSettings


def make_lattice_set(
    participant: Participant, surfaces: tuple[int, ...], deformation: stiv.Deformation, settings: EditSettings
) -> ControlSet:
    """Control set of a lattice; `deformation` stacks those of all meshes that it deforms."""
    ob = participant.reference.find()
    if ob.mode == "EDIT":
        ob.update_from_editmode()
    frame, local = as_matrix(ob.matrix_world), read_lattice_points(ob.data)
    controls = transform_points(frame, local)
    found = control_weights(ob, settings)
    max_weights = found.max_weights
    selected = _selected(ob, participant) & found.movable
    weights = response_weights(participant, selected, max_weights, settings)
    return ControlSet(
        (ob.name,), "lattice", surfaces, deformation, controls, weights, max_weights, frame,
        PointGoal(selected, controls, None, None if ob.mode == "EDIT" else frame, found.movable, found.pinned),
        LatticeWriter(participant.reference, ob.mode, frame, local),
        weight_axes=axes_of_weights(max_weights, found.directions),
    )  # fmt: skip


def check_lattice(ob: bpy.types.Object) -> None:
    """Refuse a lattice whose points cannot be edited. Raises InputError."""
    check_data(ob)
    if ob.data.shape_keys is not None:
        raise InputError(f"{ob.name}: its shape keys hide edits; apply all shape keys")
    for modifier in ob.modifiers:
        if modifier.show_viewport:
            raise modifier_error(ob, modifier.name, "of lattice")


def _selected(ob: bpy.types.Object, participant: Participant) -> Flags:
    if ob.mode == "EDIT":
        return read_collection(ob.data.points, "select", 1, np.bool_)
    return np.full(len(ob.data.points), participant.selected)


@dataclass(frozen=True)
class LatticeWriter:
    """Writes lattice points; in Edit Mode Blender updates the edited lattice from them."""

    reference: ObjectReference
    mode: str
    frame: Floats
    original: Singles

    def write(self, controls: Floats) -> None:
        """Write world positions, (m, 3)."""
        local = to_stored(self.frame, controls, self.original)
        _write_local(self.reference.find_in_mode(self.mode), local)

    def restore(self) -> None:
        """Write the original positions, in whatever mode the object is now."""
        _write_local(self.reference.find(), self.original)


def _write_local(ob: bpy.types.Object, local: Singles) -> None:
    lattice = ob.data
    if len(lattice.points) != len(local):
        raise SceneChangedError(f"{ob.name} changed its number of points")
    lattice.points.foreach_set("co_deform", local.ravel())
    lattice.update_tag()
