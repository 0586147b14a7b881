# SPDX-License-Identifier: GPL-3.0-or-later
"""Selects intersecting faces in meshes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from stiv import InputError
from stiv.blender.scene.arrays import Indices
from stiv.blender.scene.elements import FacePair, FacePairs
from stiv.blender.scene.evaluations import SHOWN
from stiv.blender.scene.mesh_reading import evaluated_mesh, read_faces
from stiv.blender.scene.modifier_stack import SubdivisionStage, read_stack


def faces_of(pairs: Sequence[FacePair]) -> dict[str, Indices]:
    """Numbers of the displayed faces in the pairs, by the names of all their objects; ascending, (n,)."""
    listed = FacePairs.of(pairs)
    found: dict[str, list[Indices]] = {name: [] for both in listed.by_objects() for name in both}
    for owner, numbers in listed.faces():
        if owner.evaluation == SHOWN:
            found[owner.object].append(numbers)
    return {name: np.unique(np.concatenate([np.empty(0, np.int32), *each])) for name, each in found.items()}


def select_faces(context: bpy.types.Context, faces: Mapping[str, Indices]) -> dict[str, int]:
    """Select exactly the faces that generate these evaluated faces, in every visible mesh; returns counts by object
    name.

    Objects in Edit Mode show the selection at once, in face select mode; others when they enter Edit Mode. Linked
    meshes, other object types, and meshes whose modifiers renumber faces are left out.
    """
    graph = context.evaluated_depsgraph_get()
    counts = {}
    for name, numbers in faces.items():
        ob = bpy.data.objects.get(name)
        if ob is None or ob.type != "MESH" or ob.data.library is not None:
            continue
        with evaluated_mesh(ob.evaluated_get(graph)) as shown:
            total = len(shown.polygons)
        if ob.mode == "EDIT":
            ob.update_from_editmode()
        origins = _origins(ob, context.scene, total)
        if origins is not None:
            chosen = np.zeros(len(ob.data.polygons), bool)
            chosen[origins[numbers]] = True
            counts[name] = int(chosen.sum())
            (_select_in_edit_mode if ob.mode == "EDIT" else _select)(ob.data, chosen)
    if any(bpy.data.objects[name].mode == "EDIT" for name in counts):
        context.tool_settings.mesh_select_mode = (False, False, True)
    return counts


def _origins(ob: bpy.types.Object, scene: bpy.types.Scene, total: int) -> Indices | None:
    """The face of the mesh that generates each evaluated face; None if unknown."""
    _, starts = read_faces(ob.data)
    corners = np.diff(starts)
    try:
        levels = [stage.levels for stage in read_stack(ob, scene) if isinstance(stage, SubdivisionStage)]
    except InputError:
        return None
    # A face of n corners becomes n quads; each further level splits these into four.
    made = corners * 4 ** (levels[0] - 1) if levels else np.ones(len(corners), np.int64)
    origins = np.repeat(np.arange(len(corners), dtype=np.int32), made)
    has_triangles = any(modifier.type == "TRIANGULATE" for modifier in ob.modifiers)
    return origins if len(origins) == total and not has_triangles else None


def _select_in_edit_mode(mesh: bpy.types.Mesh, chosen: NDArray[np.bool_]) -> None:
    edited = bmesh.from_edit_mesh(mesh)
    edited.select_mode = {"FACE"}
    for elements in (edited.verts, edited.edges, edited.faces):
        for element in elements:
            element.select = False
    for face, is_chosen in zip(edited.faces, chosen, strict=True):
        if is_chosen:
            face.select_set(True)
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


def _select(mesh: bpy.types.Mesh, chosen: NDArray[np.bool_]) -> None:
    corners, starts = read_faces(mesh)
    of_corners = np.repeat(chosen, np.diff(starts))
    vertices = np.zeros(len(mesh.vertices), bool)
    vertices[corners[of_corners]] = True
    edges = np.zeros(len(mesh.edges), bool)
    sides = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("edge_index", sides)
    edges[sides[of_corners]] = True
    mesh.polygons.foreach_set("select", chosen)
    mesh.vertices.foreach_set("select", vertices)
    # Blender 5.0.1 crashes when this attribute is written after `from_pydata`, which stores a single value.
    if (attribute := mesh.attributes.get(".select_edge")) is not None:
        mesh.attributes.remove(attribute)
    mesh.edges.foreach_set("select", edges)
    mesh.update()
