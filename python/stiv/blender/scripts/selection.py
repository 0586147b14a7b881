# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets the mode and selection of a step of an edit script."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from typing import Any

import bmesh
import bpy
import numpy as np
from numpy.typing import NDArray

from stiv import InputError
from stiv.blender.scene.curve_reading import read_curve_points, select_curve_points
from stiv.edit_scripts import EditStep

POINT_COUNTS: dict[str, Callable[[Any], int]] = {
    "MESH": lambda mesh: len(mesh.vertices),
    "LATTICE": lambda lattice: len(lattice.points),
    "CURVE": lambda curve: len(read_curve_points(curve)),
    "SURFACE": lambda surface: len(read_curve_points(surface)),
}


def select(step: EditStep) -> None:
    """Select the step's objects, the first one active, and in Edit Mode its points. Raises InputError."""
    layer = _enter_object_mode(bpy.context, step.objects)
    for obj in layer.objects:
        obj.select_set(obj.name in step.objects)
    layer.objects.active = layer.objects[step.objects[0]]
    if step.mode == "EDIT":
        _select_points(layer.objects.active, step)


def _select_points(obj: bpy.types.Object, step: EditStep) -> None:
    count = POINT_COUNTS.get(obj.type)
    if count is None:
        raise InputError(f"{obj.name}: has no points to select; choose a mesh, lattice or curve")
    chosen = np.zeros(count(obj.data), np.bool_)
    indices = np.arange(len(chosen)) if step.points is None else np.array(step.points, np.int64)
    if len(indices) and indices.max() >= len(chosen):
        raise InputError(f"{obj.name}: has {len(chosen)} points; there is no point {indices.max()}")
    chosen[indices] = True
    bpy.ops.object.mode_set(mode="EDIT")
    if obj.type == "LATTICE":
        obj.data.points.foreach_set("select", chosen)
    elif obj.type != "MESH":
        select_curve_points(obj.data, chosen)
    else:
        _select_vertices(obj.data, chosen)


def _select_vertices(mesh: bpy.types.Mesh, chosen: NDArray[np.bool_]) -> None:
    bpy.context.tool_settings.mesh_select_mode = (True, False, False)
    edited = bmesh.from_edit_mesh(mesh)
    for vertex, select_it in zip(edited.verts, chosen, strict=True):
        vertex.select = bool(select_it)
    edited.select_flush_mode()
    bmesh.update_edit_mesh(mesh, loop_triangles=False, destructive=False)


@contextmanager
def selected(context: bpy.types.Context, names: Collection[str]) -> Iterator[None]:
    """Select exactly these objects, in Object Mode, inside the `with` statement. Raises InputError."""
    layer = _enter_object_mode(context, names)
    before = [ob.name for ob in layer.objects if ob.select_get()]
    try:
        for ob in layer.objects:
            ob.select_set(ob.name in names)
        yield
    finally:
        for ob in layer.objects:
            ob.select_set(ob.name in before)


def _enter_object_mode(context: bpy.types.Context, names: Collection[str]) -> bpy.types.ViewLayer:
    """The view layer, in Object Mode. Raises InputError if it lacks one of the named objects."""
    layer = context.view_layer
    missing = [name for name in names if name not in layer.objects]
    if missing:
        raise InputError(f'there is no object "{missing[0]}" in the view layer')
    if context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    return layer
