# SPDX-License-Identifier: GPL-3.0-or-later
"""Cages of triangles subdivided by Loop's scheme; Blender has no such modifier, so an object beside a cage shows it."""

from dataclasses import dataclass
from functools import lru_cache

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv import InputError
from stiv.blender.controls.points import as_single
from stiv.blender.scene.arrays import Floats, Indices, Singles, as_matrix, read_collection, transform_points
from stiv.blender.scene.errors import SceneChangedError
from stiv.blender.scene.mesh_reading import read_creases, read_edges, read_faces
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings, LoopSurface

STALE = 1e-5  # of the size: by how much more than single precision leaves a refined mesh differs from its cage


@dataclass(frozen=True)
class Refinement:
    """From world positions of the cage's vertices to those of the refined mesh, its triangles, (T, 3), and the face of
    the cage that each lies in, (T,).
    """

    deformation: stiv.Deformation
    triangles: Indices
    faces: Indices


def refine(cage: bpy.types.Object, chosen: LoopSurface) -> Refinement:
    """The refinement of a cage; in Edit Mode as of the last `update_from_editmode`.

    Raises InputError for a face that is not a triangle.
    """
    mesh = cage.data
    corners, starts = read_faces(mesh)
    others = np.flatnonzero(np.diff(starts) != 3)
    if len(others):
        raise InputError(
            f'object "{cage.name}", face {others[0]}: has {np.diff(starts)[others[0]]} corners, and Loop subdivision '
            "takes triangles alone; triangulate the cage"
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
    """Kept for the next edit or refreshing of the same cage."""
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
    """Local positions of the refined mesh, in an object of this frame, for world positions of the cage, (m, 3)."""
    return as_single(frame, refinement.deformation.surface(cage))


@dataclass(frozen=True)
class RefinedWriter:
    """Writes the refined mesh of a cage. `original` are its local positions at the start, (n, 3)."""

    reference: ObjectReference
    refinement: Refinement
    frame: Floats
    original: Singles

    def write(self, cage: Floats) -> None:
        """Write the refined mesh of a cage at these world positions, (m, 3)."""
        _write(self.reference.find_in_mode("OBJECT"), refined_points(self.refinement, cage, self.frame))

    def restore(self) -> None:
        """Write the original positions."""
        _write(self.reference.find(), self.original)


def refined_writer(cage: bpy.types.Object, local: Singles, settings: EditSettings) -> RefinedWriter | None:
    """The writer of the mesh that shows a cage, at its local positions, (m, 3); None where it shows itself.

    Raises InputError for a refined object that is gone, or does not show the cage as it is.
    """
    chosen = settings.loops.get(cage.name)
    if chosen is None:
        return None
    refined, refinement = bpy.data.objects[chosen.object], refine(cage, chosen)
    frame, shown = as_matrix(refined.matrix_world), read_collection(refined.data.vertices, "co", 3, np.float32)
    if _is_stale(shown, refined_points(refinement, transform_points(as_matrix(cage.matrix_world), local), frame)):
        raise InputError(f'object "{refined.name}": does not show its cage "{cage.name}" as it is; refresh it')
    return RefinedWriter(ObjectReference.of(refined), refinement, frame, shown)


def refresh(cage: bpy.types.Object, refined: bpy.types.Object, chosen: LoopSurface) -> bool:
    """Let an object show the refinement of a cage as it is now; returns whether it did not.

    Raises InputError for a cage with a face that is not a triangle; nothing is changed then.
    """
    if cage.mode == "EDIT":
        cage.update_from_editmode()
    refinement = refine(cage, chosen)
    positions = read_collection(cage.data.vertices, "co", 3, np.float32)
    world = transform_points(as_matrix(cage.matrix_world), positions)
    local = refined_points(refinement, world, as_matrix(refined.matrix_world))
    shown = read_collection(refined.data.vertices, "co", 3, np.float32)
    corners = read_collection(refined.data.loops, "vertex_index", 1, np.int32)
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
        raise SceneChangedError(f'object "{refined.name}" has got another number of vertices')
    refined.data.vertices.foreach_set("co", local.ravel())
    refined.data.update()


def _rebuild(cage: bpy.types.Mesh, mesh: bpy.types.Mesh, refinement: Refinement, local: Singles) -> None:
    """Make the mesh anew; its faces take shading and material from those of the cage."""
    mesh.clear_geometry()
    mesh.from_pydata(local.tolist(), [], refinement.triangles.tolist())
    for name, dtype in (("use_smooth", np.bool_), ("material_index", np.int32)):
        values = read_collection(cage.polygons, name, 1, dtype)[refinement.faces]
        mesh.polygons.foreach_set(name, values)
    mesh.update()
