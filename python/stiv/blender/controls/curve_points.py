# SPDX-License-Identifier: GPL-3.0-or-later
"""The points of a curve or NURBS surface as controls."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.control_set import ControlSet, Participant
from stiv.blender.controls.control_weights import (
    ControlWeights,
    axes_of_weights,
    free_directions_of,
    response_weights,
)
from stiv.blender.controls.curve_surface import curve_surface
from stiv.blender.controls.editable import check_data
from stiv.blender.controls.joined_seams import SeamWriter, seam_message, selection_weights
from stiv.blender.controls.points import PointGoal, to_stored
from stiv.blender.scene.arrays import Flags, Floats, Singles, as_matrix, transform_points
from stiv.blender.scene.curve_reading import (
    movable_curve_points,
    read_curve_points,
    selected_curve_points,
    write_curve_points,
)
from stiv.blender.scene.references import ObjectReference, SceneChangedError
from stiv.blender.settings import EditSettings
from stiv.seams import find_seams


def make_curve_set(
    participant: Participant,
    surfaces: tuple[int, ...],
    evaluations: Sequence[str],
    scene: bpy.types.Scene,
    settings: EditSettings,
) -> ControlSet:
    """Control set of a curve's points; `surfaces` were read from these evaluations.

    Raises InputError if the curve cannot be edited, or if an edit changes its faces.
    """
    ob = participant.reference.find()
    check_data(ob)
    if ob.data.shape_keys is not None:
        raise InputError(f"{ob.name}: its shape keys hide edits; apply all shape keys")
    frame, local = as_matrix(ob.matrix_world), read_curve_points(ob.data)
    movable = movable_curve_points(ob.data)
    selected = movable & (selected_curve_points(ob.data) if ob.mode == "EDIT" else participant.selected)
    controls, limits = transform_points(frame, local), _limits(ob, frame, movable)
    whole = None if ob.mode == "EDIT" else frame
    made = ControlSet(
        (ob.name,), "curve", surfaces, curve_surface(ob, scene, frame, local, evaluations), controls,
        response_weights(participant, selected, limits.max_weights, settings), limits.max_weights, frame,
        PointGoal(selected, controls, None, whole, movable, limits.pinned),
        CurveWriter(participant.reference, ob.mode, frame, local),
        weight_axes=axes_of_weights(limits.max_weights, limits.directions),
    )  # fmt: skip
    return _merge_poles(made, local) if ob.type == "SURFACE" else made


def _limits(ob: bpy.types.Object, frame: Floats, movable: Flags) -> ControlWeights:
    """Weights of points that may move, (m,) flags; a 2D curve stays in its plane."""
    if ob.type == "SURFACE" or ob.data.dimensions == "3D":
        return ControlWeights(movable.astype(np.float64), None)
    directions = free_directions_of(frame[:3, :3], np.array([False, False, True]))
    return ControlWeights((movable[:, None] & directions.free).astype(np.float64), directions)


def _merge_poles(made: ControlSet, local: Singles) -> ControlSet:
    """The control set with one control for the coincident points at each pole of a NURBS surface."""
    poles = find_seams(local, np.empty((0, 3), np.int32))
    if poles is None:
        return made
    rule, first = made.rule, poles.first
    assert isinstance(rule, PointGoal)
    selected = np.bincount(poles.index, rule.selected) > 0
    weights = np.zeros(len(first))
    np.maximum.at(weights, poles.index, made.weights)
    return replace(
        made,
        deformation=stiv.compose(made.deformation, selection_weights(poles.index, len(first))),
        controls=made.controls[first],
        weights=weights,
        max_weights=made.max_weights[first],
        rule=PointGoal(selected, rule.start[first], None, rule.frame, np.ones(len(first), np.bool_)),
        writer=SeamWriter(made.writer, poles),
        control_seams=poles,
        note=seam_message(made.names[0], rule.selected, poles),
    )


@dataclass(frozen=True)
class CurveWriter:
    """Writes the points of a curve. `original` are the local positions at the start, (m, 3)."""

    reference: ObjectReference
    mode: str
    frame: Floats
    original: Singles

    def write(self, controls: Floats) -> None:
        """Write world positions, (m, 3)."""
        self._write(self.reference.find_in_mode(self.mode), to_stored(self.frame, controls, self.original), True)

    def restore(self) -> None:
        """Write the original positions, in whatever mode the object is now."""
        self._write(self.reference.find(), self.original, False)

    def _write(self, ob: bpy.types.Object, local: Singles, handles: bool) -> None:
        if len(read_curve_points(ob.data)) != len(local):
            raise SceneChangedError(f"{ob.name} changed its number of points")
        write_curve_points(ob.data, local, handles)
