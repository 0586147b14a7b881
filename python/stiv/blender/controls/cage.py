# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertices of a mesh as controls: the cage below its modifiers."""

from collections.abc import Sequence
from dataclasses import dataclass

import bmesh
import bpy
import numpy as np

import stiv
from stiv.blender.controls.cage_surface import hidden_note, read_surface_steps
from stiv.blender.controls.control_set import ControlSet, Participant, ShownAs
from stiv.blender.controls.control_weights import axes_of_weights, control_weights, response_weights
from stiv.blender.controls.editable import check_data
from stiv.blender.controls.joined_seams import join_notes
from stiv.blender.controls.key_editing import KeyEditing, check_keys
from stiv.blender.controls.loop_surfaces import RefinedWriter, refined_writer
from stiv.blender.controls.points import PointGoal, to_stored
from stiv.blender.controls.shared_meshes import sharing_note
from stiv.blender.scene.arrays import Flags, Floats, Singles, as_matrix, read_collection, transform_points
from stiv.blender.scene.evaluations import is_edited
from stiv.blender.scene.mesh_reading import read_cage, read_edges
from stiv.blender.scene.mesh_writing import write_positions
from stiv.blender.scene.references import ObjectReference, SceneChangedError
from stiv.blender.settings import EditSettings
from stiv.task import Steps, run


def make_cage_set(
    participant: Participant,
    surfaces: tuple[int, ...],
    shown: Sequence[ShownAs],
    scene: bpy.types.Scene,
    settings: EditSettings,
) -> ControlSet:
    """Control set of a mesh's cage; `shown` says where its `surfaces` were read.

    Raises InputError if the mesh cannot be edited, or has modifiers that no edit can follow.
    """
    return run(make_cage_set_steps(participant, surfaces, shown, scene, settings))


def make_cage_set_steps(
    participant: Participant,
    surfaces: tuple[int, ...],
    shown: Sequence[ShownAs],
    scene: bpy.types.Scene,
    settings: EditSettings,
) -> Steps[ControlSet]:
    """Steps of `make_cage_set`."""
    ob = participant.reference.find()
    frame, local = open_cage(ob)
    found = control_weights(ob, settings)
    max_weights = found.max_weights
    writer = cage_writer(participant.reference, ob, frame, local, settings)
    surface = yield from read_surface_steps(ob, scene, writer, shown)
    ob = participant.reference.find()
    selected = selected_vertices(ob, participant.selected) & found.movable
    controls = transform_points(frame, local)
    whole = None if ob.mode == "EDIT" else frame
    return ControlSet(
        (ob.name,), "cage", surfaces, surface.deformation or stiv.identity(len(local)), controls,
        response_weights(participant, selected, max_weights, settings), max_weights, frame,
        PointGoal(selected, controls, read_edges(ob.data), whole, found.movable, found.pinned),
        surface.limited(writer), note=join_notes(sharing_note(ob), hidden_note(ob, shown)),
        weight_axes=axes_of_weights(max_weights, found.directions),
        observed=surface.observed,
    )  # fmt: skip


def open_cage(ob: bpy.types.Object) -> tuple[Floats, Singles]:
    """Frame and local positions, (m, 3), of an editable cage; updates it from Edit Mode."""
    check_data(ob)
    if ob.mode == "EDIT":
        ob.update_from_editmode()
    check_keys(ob)
    return as_matrix(ob.matrix_world), read_cage(ob)


def selected_vertices(ob: bpy.types.Object, selected: bool) -> Flags:
    """Flags of the selected vertices in Edit Mode, otherwise all or none, (m,)."""
    if ob.mode == "EDIT":
        return read_collection(ob.data.vertices, "select", 1, np.bool_)
    return np.full(len(ob.data.vertices), selected)


@dataclass(frozen=True)
class CageWriter:
    """Writes cage vertices, or shape keys. `original` are the local positions shown at the start, (m, 3)."""

    reference: ObjectReference
    mode: str
    frame: Floats
    original: Singles
    refined: RefinedWriter | None = None
    keys: KeyEditing | None = None

    def write(self, controls: Floats) -> None:
        """Write world positions, (m, 3), to the cage and to the object that shows it."""
        local = to_stored(self.frame, controls, self.original)
        ob = self.reference.find_in_mode(self.mode)
        shown = local
        if self.keys is not None:
            self.keys.check(ob)
            shown = self.keys.shown_positions(local)
        _write_local(ob, local, self.keys)
        if self.refined is not None:
            self.refined.write(transform_points(self.frame, shown))

    def restore(self) -> None:
        """Write the original positions, in whatever mode the object is now."""
        ob = self.reference.find()
        if self.keys is not None:
            self.keys.restore(ob)
        if self.keys is None or is_edited(ob):
            _write_local(ob, self.original, self.keys)
        if self.refined is not None:
            self.refined.restore()


def cage_writer(
    reference: ObjectReference,
    ob: bpy.types.Object,
    frame: Floats,
    local: Singles,
    settings: EditSettings,
) -> CageWriter:
    """Writer of a cage at local positions, (m, 3), in its present mode. Raises InputError."""
    return CageWriter(reference, ob.mode, frame, local, refined_writer(ob, local, settings), KeyEditing.of(ob))


def _write_local(ob: bpy.types.Object, local: Singles, keys: KeyEditing | None) -> None:
    if len(local) != _vertex_count(ob):
        raise SceneChangedError(f"{ob.name} changed its number of vertices")
    if is_edited(ob):
        _write_edit_mesh(ob.data, local if keys is None else keys.active_positions(local))
    elif keys is not None:
        keys.write(ob, local)
    else:
        write_positions(ob.data, local)


def _vertex_count(ob: bpy.types.Object) -> int:
    return len(bmesh.from_edit_mesh(ob.data).verts) if is_edited(ob) else len(ob.data.vertices)


def _write_edit_mesh(mesh: bpy.types.Mesh, local: Singles) -> None:
    """Set each vertex: `foreach_set` does not reach the edit mesh.

    A generator of tuples: as many lists at once would trigger Python's garbage collection, which takes longer.
    """
    edit_mesh = bmesh.from_edit_mesh(mesh)
    for vertex, position in zip(edit_mesh.verts, zip(*local.T.tolist(), strict=True), strict=True):
        vertex.co = position
    edit_mesh.normal_update()
    bmesh.update_edit_mesh(mesh, loop_triangles=True, destructive=False)
