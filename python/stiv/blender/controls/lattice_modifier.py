# SPDX-License-Identifier: GPL-3.0-or-later
"""What the points of one lattice do to the evaluated mesh of one object."""

from typing import Any

import bpy
import numpy as np

import stiv
from stiv.blender.controls.cage import read_cage
from stiv.blender.controls.deformation_cache import remembered
from stiv.blender.controls.lattice_points import is_undeformed, read_points, read_rest_points
from stiv.blender.controls.subdivision import subdivide
from stiv.blender.scene.arrays import Floats, Singles, as_matrix, transform_points
from stiv.blender.scene.evaluations import SHOWN
from stiv.blender.scene.mesh_reading import evaluated_mesh, read_group_weights
from stiv.blender.scene.modifier_stack import Bending, Stage, Subdivision, read_stack, refuse
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.vertex_groups import group_weights


def bent_mesh(
    ob: bpy.types.Object, lattice: ObjectReference, context: bpy.types.Context, evaluation: str = SHOWN
) -> stiv.Deformation:
    """From world positions of the lattice's points to those of the object's mesh in an evaluation.

    Stages before the lattice are followed at their present values. Raises InputError naming object and modifier.
    """
    if ob.mode == "EDIT":
        ob.update_from_editmode()
    stages = read_stack(ob, context.scene, evaluation)
    place = [getattr(stage, "lattice", None) for stage in stages].index(lattice)
    rest = transform_points(as_matrix(ob.matrix_world), read_cage(ob))
    for stage in stages[:place]:
        rest = _followed(ob, stage, rest, context).surface(_present_controls(stage, rest))
    bending = stages[place]
    assert isinstance(bending, Bending)
    result = _lattice(ob, bending, rest, context)
    for stage in stages[place + 1 :]:
        if isinstance(stage, Subdivision):
            result = stiv.compose(subdivide(ob.data, stage), result)
        else:
            _check_undeformed(ob, stage)
    return result


def _check_undeformed(ob: bpy.types.Object, stage: Bending) -> None:
    if not is_undeformed(stage.lattice.find().data):
        raise refuse(ob, stage.modifier, "is a deformed lattice after the one that moves")


def _followed(ob: bpy.types.Object, stage: Stage, rest: Floats, context: bpy.types.Context) -> stiv.Deformation:
    if isinstance(stage, Subdivision):
        return subdivide(ob.data, stage)
    return _lattice(ob, stage, rest, context)


def _present_controls(stage: Stage, rest: Floats) -> Floats:
    if isinstance(stage, Subdivision):
        return rest
    lattice = stage.lattice.find()
    return transform_points(as_matrix(lattice.matrix_world), read_points(lattice.data))


def _lattice(ob: bpy.types.Object, stage: Bending, rest: Floats, context: bpy.types.Context) -> stiv.Deformation:
    lattice = stage.lattice.find()
    data = lattice.data
    return remembered(
        _bent,
        rest,
        (data.points_u, data.points_v, data.points_w),
        as_matrix(lattice.matrix_world),
        [_interpolation(data, axis) for axis in "uvw"],
        stage.strength * _group_weights(ob, stage, len(rest), context),
        read_rest_points(data),
        _point_weights(lattice),
    )


def _bent(
    vertices: Floats,
    resolution: tuple[int, int, int],
    frame: Floats,
    interpolation: list[str],
    influence: Floats,
    rest: Singles,
    point_weights: Any,
) -> stiv.Deformation:
    return stiv.lattice(
        vertices,
        resolution,
        frame=frame,
        interpolation=interpolation,
        influence=influence,
        rest=rest,
        point_weights=point_weights,
    )


def _interpolation(lattice: bpy.types.Lattice, axis: str) -> str:
    name: str = getattr(lattice, f"interpolation_type_{axis}")
    return name.removeprefix("KEY_").lower()


def _point_weights(lattice: bpy.types.Object) -> Any:
    name = lattice.data.vertex_group
    return group_weights(lattice, name, "that of the points") if name in lattice.vertex_groups else None


def _group_weights(ob: bpy.types.Object, stage: Bending, count: int, context: bpy.types.Context) -> Floats:
    """Weights of the modifier's vertex group for each vertex that the lattice sees, (n,)."""
    if stage.vertex_group is None:
        return np.ones(count)
    if count == len(ob.data.vertices):
        weights = read_group_weights(ob.data.vertices, stage.vertex_group)
    else:
        with evaluated_mesh(ob.evaluated_get(context.evaluated_depsgraph_get())) as mesh:
            weights = read_group_weights(mesh.vertices, stage.vertex_group)
    return np.asarray(1.0 - weights if stage.inverted else weights, np.float64)
