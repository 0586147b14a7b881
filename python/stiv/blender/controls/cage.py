# SPDX-License-Identifier: GPL-3.0-or-later
"""The vertices of a mesh as controls: the cage below its modifiers."""

from collections.abc import Sequence
from dataclasses import dataclass

import bmesh
import bpy
import numpy as np

import stiv
from stiv.blender.controls.control_set import Part
from stiv.blender.controls.control_weights import ControlWeights, axes_of_weights, control_weights
from stiv.blender.controls.editable import check_data
from stiv.blender.controls.lattice_points import is_undeformed
from stiv.blender.controls.loop_surfaces import RefinedWriter, refined_writer
from stiv.blender.controls.movers import Mover
from stiv.blender.controls.points import PointGoal, point_weights, stored
from stiv.blender.controls.subdivision import stacked, subdivide, unchanged
from stiv.blender.scene.arrays import Flags, Floats, Singles, as_matrix, read_collection, transform_points
from stiv.blender.scene.errors import SceneChangedError
from stiv.blender.scene.evaluations import SHOWN
from stiv.blender.scene.mesh_reading import read_edges
from stiv.blender.scene.modifier_stack import Bending, Subdivision, read_stack, refuse
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings


def cage_part(
    mover: Mover, surfaces: tuple[int, ...], evaluations: Sequence[str], scene: bpy.types.Scene, settings: EditSettings
) -> Part:
    """The cage of a mesh object as a part; its surfaces were read in these evaluations.

    Raises InputError where it cannot be changed or followed.
    """
    ob = mover.reference.find()
    frame, local = open_cage(ob)
    found = control_weights(ob, settings)
    given = found.given
    writer = cage_writer(mover.reference, ob, frame, local, settings, found)
    deformation = subdivision_in(ob, scene, writer, evaluations) or stiv.identity(len(local))
    selected = selected_vertices(ob, mover.selected) & found.movable
    others = settings.weight(False) if mover.selected else 1.0
    controls = transform_points(frame, local)
    origin = None if ob.mode == "EDIT" else frame[:3, 3]
    return Part(
        (ob.name,), "cage", surfaces, deformation, controls,
        point_weights(selected, settings.weight(True), others, given), given, frame,
        PointGoal(selected, controls, read_edges(ob.data), origin, found.movable, found.pinned),
        writer, weight_axes=axes_of_weights(given, found.directions),
    )  # fmt: skip


def open_cage(ob: bpy.types.Object) -> tuple[Floats, Singles]:
    """Frame and local positions, (m, 3), of a cage that can be changed, Edit Mode brought up to date."""
    check_data(ob)
    if ob.mode == "EDIT":
        ob.update_from_editmode()
    return as_matrix(ob.matrix_world), read_cage(ob)


def read_cage(ob: bpy.types.Object) -> Singles:
    """Local positions of the cage, (m, 3); in Edit Mode as of the last `update_from_editmode`."""
    keys = ob.data.shape_keys
    points = ob.data.vertices if keys is None or ob.mode == "EDIT" else keys.key_blocks[0].data
    return read_collection(points, "co", 3, np.float32)


def subdivision_in(
    ob: bpy.types.Object, scene: bpy.types.Scene, writer: "CageWriter", evaluations: Sequence[str]
) -> stiv.Deformation | None:
    """What becomes of the cage in each evaluation, side by side; None where there is one, and it stays as it is.

    Raises InputError for modifiers that cannot be followed.
    """
    found = [_subdivision_of(ob, scene, writer, each) for each in evaluations or (SHOWN,)]
    if len(found) == 1:
        return found[0]
    return stacked([unchanged(_vertex_count(ob)) if each is None else each for each in found])


def _subdivision_of(
    ob: bpy.types.Object, scene: bpy.types.Scene, writer: "CageWriter", evaluation: str
) -> stiv.Deformation | None:
    """What becomes of the cage: Loop's subdivision beside it, that of its modifiers, or None where it stays as it is.

    Raises InputError for modifiers that cannot be followed.
    """
    if writer.refined is not None:
        return writer.refined.refinement.deformation
    result = None
    for stage in read_stack(ob, scene, evaluation):
        if isinstance(stage, Bending) and not is_undeformed(stage.lattice.find().data):
            raise refuse(
                ob, stage.modifier,
                f'lattice "{stage.lattice.name}" is deformed, and the cage below it cannot be followed; '
                "select the lattice instead",
            )  # fmt: skip
        if isinstance(stage, Subdivision):
            result = subdivide(ob.data, stage)
    return result


def selected_vertices(ob: bpy.types.Object, selected: bool) -> Flags:
    """In Edit Mode the vertices that are selected there, else all or none, (m,)."""
    if ob.mode == "EDIT":
        return read_collection(ob.data.vertices, "select", 1, np.bool_)
    return np.full(len(ob.data.vertices), selected)


@dataclass(frozen=True)
class CageWriter:
    """Writes cage vertices.

    `original` are the local positions at the start, (m, 3); `kept` the coordinates of them that are pinned, (m, 3).
    """

    reference: ObjectReference
    mode: str
    frame: Floats
    original: Singles
    refined: RefinedWriter | None = None
    kept: Flags | None = None

    def write(self, controls: Floats) -> None:
        """Write world positions, (m, 3), and what shows them."""
        local = stored(self.frame, controls, self.original, self.kept)
        _write_local(self.reference.find_in_mode(self.mode), local)
        if self.refined is not None:
            self.refined.write(transform_points(self.frame, local))

    def restore(self) -> None:
        """Write the original positions, in whatever mode the object is by now."""
        _write_local(self.reference.find(), self.original)
        if self.refined is not None:
            self.refined.restore()


def cage_writer(
    reference: ObjectReference,
    ob: bpy.types.Object,
    frame: Floats,
    local: Singles,
    settings: EditSettings,
    weights: ControlWeights,
) -> CageWriter:
    """The writer of a cage at these local positions, (m, 3), in the mode that it is in. Raises InputError."""
    return CageWriter(reference, ob.mode, frame, local, refined_writer(ob, local, settings), weights.kept_coordinates)


def _write_local(ob: bpy.types.Object, local: Singles) -> None:
    if len(local) != _vertex_count(ob):
        raise SceneChangedError(f'object "{ob.name}" has got another number of vertices')
    if ob.mode == "EDIT":
        _write_edit_mesh(ob.data, local)
    else:
        _write_mesh(ob.data, local)


def _vertex_count(ob: bpy.types.Object) -> int:
    return len(bmesh.from_edit_mesh(ob.data).verts) if ob.mode == "EDIT" else len(ob.data.vertices)


def _write_mesh(mesh: bpy.types.Mesh, local: Singles) -> None:
    """With shape keys (a Basis alone), the keys are what Blender evaluates; mesh and key are kept the same."""
    mesh.vertices.foreach_set("co", local.ravel())
    if mesh.shape_keys is not None:
        mesh.shape_keys.key_blocks[0].data.foreach_set("co", local.ravel())
    mesh.update()


def _write_edit_mesh(mesh: bpy.types.Mesh, local: Singles) -> None:
    """`foreach_set` does not reach the edit mesh, so each vertex is set by itself.

    One tuple after the other: as many lists at once make Python look for garbage, which takes longer than all this.
    """
    edit_mesh = bmesh.from_edit_mesh(mesh)
    for vertex, position in zip(edit_mesh.verts, zip(*local.T.tolist(), strict=True), strict=True):
        vertex.co = position
    edit_mesh.normal_update()
    bmesh.update_edit_mesh(mesh, loop_triangles=True, destructive=False)
