# SPDX-License-Identifier: GPL-3.0-or-later
"""Loop subdivision of triangle cages. Blender has no such modifier, so a child of the cage shows the refined mesh."""

from dataclasses import dataclass
from functools import lru_cache

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv import InputError
from stiv.blender.controls.editable import check_data
from stiv.blender.controls.points import to_single
from stiv.blender.scene.arrays import Floats, Indices, Singles, as_matrix, read_collection, transform_points
from stiv.blender.scene.evaluations import SHOWS_PARENT
from stiv.blender.scene.mesh_reading import read_corner_vertices, read_creases, read_edges, read_faces, read_positions
from stiv.blender.scene.mesh_writing import write_positions
from stiv.blender.scene.references import ObjectReference, SceneChangedError
from stiv.blender.settings import EditSettings, LoopSurface

STALE = 1e-5  # of its size: maximum difference between the shown and the computed mesh, above single precision


@dataclass(frozen=True)
class Refinement:
    """Deformation from the cage to the refined mesh, its triangles, (T, 3), and the cage face of each, (T,)."""

    deformation: stiv.Deformation
    triangles: Indices
    faces: Indices


def refine(cage: bpy.types.Object, chosen: LoopSurface) -> Refinement:
    """Refine a cage; in Edit Mode as of the last `update_from_editmode`.

    Raises InputError for a face that is not a triangle.
    """
    mesh = cage.data
    corners, starts = read_faces(mesh)
    others = np.flatnonzero(np.diff(starts) != 3)
    if len(others):
        raise InputError(
            f"{cage.name}: face {others[0]} has {np.diff(starts)[others[0]]} corners; triangulate the cage"
        )
    edge_crease, vertex_crease = read_creases(mesh)
    creases = [None if values is None else values.tobytes() for values in (edge_crease, vertex_crease)]
    return _refinement(
        len(mesh.vertices), corners.tobytes(), read_edges(mesh).tobytes(), creases[0], creases[1],
        chosen.levels, chosen.boundary,
    )  # fmt: skip


@lru_cache(maxsize=8)
def _refinement(
    count: int, corners: bytes, edges: bytes, edge_crease: bytes | None, vertex_crease: bytes | None, levels: int,
    boundary: str,
) -> Refinement:  # fmt: skip
    """Cached for the next edit or refresh of the same cage."""
    vertices = _indices(corners)
    cage = stiv.Cage(
        count, vertices, np.arange(0, len(vertices) + 1, 3), _indices(edges).reshape(-1, 2),
        _singles(edge_crease), _singles(vertex_crease),
    )  # fmt: skip
    deformation, triangles = stiv.loop(cage, levels, boundary=boundary)
    return Refinement(deformation, triangles, np.repeat(np.arange(len(vertices) // 3, dtype=np.int32), 4**levels))


def _indices(values: bytes) -> Indices:
    return np.frombuffer(values, np.int32)


def _singles(values: bytes | None) -> NDArray[np.float32] | None:
    return None if values is None else np.frombuffer(values, np.float32)


def refined_points(refinement: Refinement, cage: Floats, frame: Floats) -> Singles:
    """Local positions of the refined mesh in an object's frame, from world positions of the cage, (m, 3)."""
    return to_single(frame, refinement.deformation.surface(cage))


@dataclass(frozen=True)
class RefinedWriter:
    """Writes the refined mesh of a cage. `original` are its local positions at the start, (n, 3)."""

    reference: ObjectReference
    refinement: Refinement
    frame: Floats
    original: Singles

    def write(self, cage: Floats) -> None:
        """Write the refined mesh of a cage at world positions, (m, 3)."""
        _write(self.reference.find_in_mode("OBJECT"), refined_points(self.refinement, cage, self.frame))

    def restore(self) -> None:
        """Write the original positions."""
        _write(self.reference.find(), self.original)


def refined_writer(cage: bpy.types.Object, local: Singles, settings: EditSettings) -> RefinedWriter | None:
    """Writer of the mesh that shows a cage, at its local positions, (m, 3); None if the cage shows itself.

    Raises InputError if the refined object was removed or is not up to date.
    """
    chosen = settings.loops.get(cage.name)
    if chosen is None:
        return None
    refined, refinement = bpy.data.objects[chosen.object], refine(cage, chosen)
    frame, shown = as_matrix(refined.matrix_world), read_positions(refined.data)
    if _is_stale(shown, refined_points(refinement, transform_points(as_matrix(cage.matrix_world), local), frame)):
        raise InputError(f'{refined.name}: is older than its cage "{cage.name}"; use Refresh')
    return RefinedWriter(ObjectReference.of(refined), refinement, frame, shown)


def refresh(cage: bpy.types.Object, refined: bpy.types.Object, chosen: LoopSurface) -> bool:
    """Update the object that shows a cage; returns whether it changed.

    Raises InputError, with nothing changed, for a cage with a face that is not a triangle.
    """
    if cage.mode == "EDIT":
        cage.update_from_editmode()
    refinement = refine(cage, chosen)
    positions = read_collection(cage.data.vertices, "co", 3, np.float32)
    world = transform_points(as_matrix(cage.matrix_world), positions)
    local = refined_points(refinement, world, as_matrix(refined.matrix_world))
    shown = read_positions(refined.data)
    corners = read_corner_vertices(refined.data)
    if not np.array_equal(corners, refinement.triangles.ravel()):
        _rebuild(cage.data, refined.data, refinement, local)
    elif _is_stale(shown, local):
        _write(refined, local)
    else:
        return False
    return True


def _is_stale(shown: Singles, wanted: Singles) -> bool:
    if shown.shape != wanted.shape:
        return True
    size = float(np.abs(wanted).max(initial=0.0))
    return bool(np.abs(shown - wanted).max(initial=0.0) > STALE * size)


def _write(refined: bpy.types.Object, local: Singles) -> None:
    if len(refined.data.vertices) != len(local):
        raise SceneChangedError(f"{refined.name} changed its number of vertices")
    write_positions(refined.data, local)


def _rebuild(cage: bpy.types.Mesh, mesh: bpy.types.Mesh, refinement: Refinement, local: Singles) -> None:
    """Rebuild the mesh; its faces inherit shading and material from those of the cage."""
    mesh.clear_geometry()
    mesh.from_pydata(local.tolist(), [], refinement.triangles.tolist())
    for name, dtype in (("use_smooth", np.bool_), ("material_index", np.int32)):
        values = read_collection(cage.polygons, name, 1, dtype)[refinement.faces]
        mesh.polygons.foreach_set(name, values)
    mesh.update()


def add_refined(context: bpy.types.Context, cage: bpy.types.Object, levels: int, boundary: str) -> bpy.types.Object:
    """Add the object "<name>.loop": a child at the cage's place, in its collections, with its materials.

    It cannot be selected, so that clicks select the cage. Raises InputError, with nothing changed, if the cage cannot
    be edited or has a face that is not a triangle.
    """
    check_data(cage)
    if not len(cage.data.polygons):
        raise InputError(f"{cage.name}: has no faces; add triangles")
    refine(cage, LoopSurface("", levels, boundary))  # may raise InputError before anything is created
    name = f"{cage.name}.loop"
    refined = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    refined.parent = cage
    refined[SHOWS_PARENT] = True
    for material in cage.data.materials:
        refined.data.materials.append(material)
    for collection in cage.users_collection:
        collection.objects.link(refined)
    refined.hide_select = True
    context.view_layer.update()
    refresh(cage, refined, LoopSurface(refined.name, levels, boundary))
    return refined


def remove_refined(refined: bpy.types.Object) -> None:
    """Delete the object and its mesh."""
    mesh = refined.data
    bpy.data.objects.remove(refined)
    if mesh.users == 0:
        bpy.data.meshes.remove(mesh)
