# SPDX-License-Identifier: GPL-3.0-or-later
"""The deformation of one object's evaluated mesh by a lattice."""

from typing import Any

import bpy
import numpy as np

import stiv
from stiv.blender.controls.deformation_cache import cached_deformation
from stiv.blender.controls.subdivision import subdivide
from stiv.blender.scene.arrays import Floats, as_matrix, transform_points
from stiv.blender.scene.evaluations import SHOWN
from stiv.blender.scene.lattice_reading import is_undeformed, read_lattice_points, read_rest_lattice_points
from stiv.blender.scene.mesh_reading import evaluated_mesh, read_cage
from stiv.blender.scene.modifier_stack import LatticeStage, Stage, SubdivisionStage, modifier_error, read_stack
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.vertex_groups import group_weights, read_group_weights


def lattice_deformation(
    ob: bpy.types.Object, lattice: ObjectReference, context: bpy.types.Context, evaluation: str = SHOWN
) -> stiv.Deformation:
    """Deformation from world positions of the lattice's points to the object's mesh in an evaluation.

    Modifiers before the lattice are evaluated at their present values. Raises InputError naming object and modifier.
    """
    if ob.mode == "EDIT":
        ob.update_from_editmode()
    stages = read_stack(ob, context.scene, evaluation)
    place = [getattr(stage, "lattice", None) for stage in stages].index(lattice)
    rest = transform_points(as_matrix(ob.matrix_world), read_cage(ob))
    for stage in stages[:place]:
        rest = _evaluate_stage(ob, stage, rest, context).surface(_present_controls(stage, rest))
    lattice_stage = stages[place]
    assert isinstance(lattice_stage, LatticeStage)
    result = _lattice(ob, lattice_stage, rest, context)
    for stage in stages[place + 1 :]:
        if isinstance(stage, SubdivisionStage):
            result = stiv.compose(subdivide(ob.data, stage), result)
        else:
            _check_undeformed(ob, stage)
    return result


def _check_undeformed(ob: bpy.types.Object, stage: LatticeStage) -> None:
    if not is_undeformed(stage.lattice.find().data):
        raise modifier_error(ob, stage.modifier, "after moving lattice")


def _evaluate_stage(ob: bpy.types.Object, stage: Stage, rest: Floats, context: bpy.types.Context) -> stiv.Deformation:
    if isinstance(stage, SubdivisionStage):
        return subdivide(ob.data, stage)
    return _lattice(ob, stage, rest, context)


def _present_controls(stage: Stage, rest: Floats) -> Floats:
    if isinstance(stage, SubdivisionStage):
        return rest
    lattice = stage.lattice.find()
    return transform_points(as_matrix(lattice.matrix_world), read_lattice_points(lattice.data))


def _lattice(ob: bpy.types.Object, stage: LatticeStage, rest: Floats, context: bpy.types.Context) -> stiv.Deformation:
    lattice = stage.lattice.find()
    data = lattice.data
    return cached_deformation(
        stiv.lattice, rest, (data.points_u, data.points_v, data.points_w), frame=as_matrix(lattice.matrix_world),
        interpolation=[_interpolation(data, axis) for axis in "uvw"],
        influence=stage.strength * _group_weights(ob, stage, len(rest), context),
        rest=read_rest_lattice_points(data), point_weights=_point_weights(lattice),
    )  # fmt: skip


def _interpolation(lattice: bpy.types.Lattice, axis: str) -> str:
    name: str = getattr(lattice, f"interpolation_type_{axis}")
    return name.removeprefix("KEY_").lower()


def _point_weights(lattice: bpy.types.Object) -> Any:
    name = lattice.data.vertex_group
    return group_weights(lattice, name, "that of the points") if name in lattice.vertex_groups else None


def _group_weights(ob: bpy.types.Object, stage: LatticeStage, count: int, context: bpy.types.Context) -> Floats:
    """Weights of the modifier's vertex group for each of its input vertices, (n,)."""
    if stage.vertex_group is None:
        return np.ones(count)
    if count == len(ob.data.vertices):
        weights = read_group_weights(ob.data.vertices, stage.vertex_group)
    else:
        with evaluated_mesh(ob.evaluated_get(context.evaluated_depsgraph_get())) as mesh:
            weights = read_group_weights(mesh.vertices, stage.vertex_group)
    return np.asarray(1.0 - weights if stage.inverted else weights, np.float64)
