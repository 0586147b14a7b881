# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds out by trial whether all that Geometry Nodes show moves with their object, whatever objects they refer to."""

import bpy
import mathutils
import numpy as np

from stiv.blender.scene.arrays import Floats, as_matrix, transform_points
from stiv.blender.scene.evaluation_copies import EvaluationCopies
from stiv.blender.scene.evaluations import VIEWPORT
from stiv.blender.scene.mesh_reading import evaluated_mesh, read_positions

TOLERANCE = 1e-5  # of the coordinates: rounding of two evaluations
ROTATION = mathutils.Euler((0.3, -0.5, 0.7)).to_matrix().to_4x4()


def moves_as_a_whole(ob: bpy.types.Object) -> bool:
    """Does an object with Geometry Nodes show the same shape, moved, after a translation and a rotation of a copy?"""
    if not any(isinstance(modifier, bpy.types.NodesModifier) for modifier in ob.modifiers):
        return False
    copies = EvaluationCopies(bpy.context.scene, VIEWPORT)
    try:
        copies.fill([ob], lambda other: other == ob)
        start = _shown(copies)
        size = float(np.abs(start).max(initial=0.0)) or 1.0
        motion = mathutils.Matrix.Translation((0.3 * size, 0.2 * size, -0.1 * size)) @ ROTATION
        twin = copies.scene.collection.objects[0]
        twin.matrix_world = motion @ ob.matrix_world
        copies.depsgraph.update()
        moved = _shown(copies)
    finally:
        copies.remove()
    if len(start) == 0 or moved.shape != start.shape:
        return False
    return bool(np.abs(transform_points(as_matrix(motion), start) - moved).max() <= TOLERANCE * size)


def _shown(copies: EvaluationCopies) -> Floats:
    """World positions of all meshes and instances, (n, 3)."""
    found = [np.empty((0, 3))]
    for instance in copies.depsgraph.object_instances:
        if instance.object.type == "MESH" and (instance.show_self or instance.is_instance):
            with evaluated_mesh(instance.object) as mesh:
                found.append(transform_points(as_matrix(instance.matrix_world), read_positions(mesh)))
    return np.concatenate(found)
