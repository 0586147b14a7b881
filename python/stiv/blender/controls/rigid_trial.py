# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds out by trial whether all that Geometry Nodes show moves with their object, whatever they refer to."""

import bpy
import mathutils
import numpy as np

from stiv.blender.scene.arrays import Floats, as_matrix, invert, transform_points
from stiv.blender.scene.dependencies import has_node, referenced_objects
from stiv.blender.scene.evaluation_copies import EvaluationCopies
from stiv.blender.scene.evaluations import VIEWPORT, is_active
from stiv.blender.scene.mesh_reading import evaluated_mesh, read_positions
from stiv.blender.scene.modifier_stack import modifier_error

TOLERANCE = 1e-5  # of the coordinates: rounding of two evaluations
ROTATION = mathutils.Euler((0.3, -0.5, 0.7)).to_matrix().to_4x4()
SHIFT = mathutils.Vector((0.3, 0.2, -0.1))  # in sizes
TRIALS = {  # by the kind of an edit: the motion of the object's own axes, and its translation
    "move": (mathutils.Matrix.Identity(4), SHIFT),
    "rotate": (ROTATION, 0 * SHIFT),  # the pivot may be the object's origin
    "scale": (mathutils.Matrix.Diagonal((1.1, 0.8, 1.3, 1.0)), 0 * SHIFT),
}
SELF_OBJECT = "GeometryNodeSelfObject"


def moves_as_a_whole(ob: bpy.types.Object) -> bool:
    """Does an object with Geometry Nodes show the same shape, moved, after a translation and a rotation of a copy?"""
    if not any(isinstance(modifier, bpy.types.NodesModifier) for modifier in ob.modifiers):
        return False
    return _shows_the_same(ob, ROTATION, SHIFT)


def check_own_transform(ob: bpy.types.Object, kind: str) -> None:
    """Raise InputError for Geometry Nodes that read the object's own transform, and then show another shape.

    kind: of the edit: "move", "rotate" or "scale".
    """
    readers = [modifier.name for modifier in ob.modifiers if is_active(modifier, ob) and _reads_own(modifier, ob)]
    if readers and not _shows_the_same(ob, *TRIALS[kind]):
        raise modifier_error(ob, readers[0], "own transform")


def _reads_own(modifier: bpy.types.Modifier, ob: bpy.types.Object) -> bool:
    """Can Geometry Nodes read the transform of their object?"""
    if not isinstance(modifier, bpy.types.NodesModifier):
        return False
    return has_node(modifier.node_group, SELF_OBJECT) or ob in referenced_objects(modifier)


def _shows_the_same(ob: bpy.types.Object, linear: mathutils.Matrix, shift: mathutils.Vector) -> bool:
    """Does a copy show the same shape, moved, after a motion of its own axes, (4, 4), and a translation, in sizes?"""
    copies = EvaluationCopies(bpy.context.scene, VIEWPORT)
    try:
        copies.fill([ob], lambda other: other == ob)
        start = _shown(copies)
        size = float(np.abs(start).max(initial=0.0)) or 1.0
        twin = copies.scene.collection.objects[0]
        twin.matrix_world = mathutils.Matrix.Translation(size * shift) @ ob.matrix_world @ linear
        motion = as_matrix(twin.matrix_world) @ invert(as_matrix(ob.matrix_world))
        copies.depsgraph.update()
        moved = _shown(copies)
    finally:
        copies.remove()
    if len(start) == 0 or moved.shape != start.shape:
        return False
    return bool(np.abs(transform_points(motion, start) - moved).max() <= TOLERANCE * size)


def _shown(copies: EvaluationCopies) -> Floats:
    """World positions of all meshes and instances, (n, 3)."""
    found = [np.empty((0, 3))]
    for instance in copies.depsgraph.object_instances:
        if instance.object.type == "MESH" and (instance.show_self or instance.is_instance):
            with evaluated_mesh(instance.object) as mesh:
                found.append(transform_points(as_matrix(instance.matrix_world), read_positions(mesh)))
    return np.concatenate(found)
