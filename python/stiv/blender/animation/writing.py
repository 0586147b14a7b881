# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a resolved animation: keyframes of placements, and a shape key for each key of a deforming mesh.

The result is independent: parents, constraints, modifiers and old animation are removed. Interpolation is linear.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import bpy
import mathutils
import numpy as np

from stiv.blender.animation.controls import MovingSet, stored_placement
from stiv.blender.animation.fixed_triangulation import flipped_faces, split_faces
from stiv.blender.animation.resolving import Key, Resolved
from stiv.blender.animation.tracks import Track
from stiv.blender.scene.arrays import Floats, Singles, invert, transform_points
from stiv.blender.scene.mesh_reading import evaluated_mesh
from stiv.blender.scene.open_evaluations import open_evaluations
from stiv.blender.verify.frame_check import set_frame


def write_animation(context: bpy.types.Context, tracks: Sequence[Track], resolved: Resolved) -> None:
    """Replace the animation of all moving objects. The scene ends at the first frame."""
    set_frame(context.scene, resolved.keys[0].frame)
    meshes = _evaluated_meshes(context, tracks, resolved.moving_sets)
    for moving_set in resolved.moving_sets:
        for index in moving_set.tracks:
            _free(tracks[index].mesh.owner.find())
    first = 0
    with _linear_keys(context):
        for moving_set in resolved.moving_sets:
            rows = slice(first, first + len(moving_set.controls))
            first = rows.stop
            keys = [Key(key.frame, key.controls[rows]) for key in resolved.keys]
            if moving_set.frame is None:
                _write_placements(moving_set, tracks, keys)
            else:
                _write_shape(moving_set, tracks[moving_set.tracks[0]], meshes[moving_set.tracks[0]], keys)
    _fix_triangulations(context, tracks, resolved)
    set_frame(context.scene, resolved.keys[0].frame)


def _fix_triangulations(context: bpy.types.Context, tracks: Sequence[Track], resolved: Resolved) -> None:
    """Split the faces that Blender would triangulate differently from the first frame at any key.

    Only the triangles of the first frame are known to be free of intersections.
    """
    shapes = [tracks[each.tracks[0]].mesh for each in resolved.moving_sets if each.frame is not None]
    flipped: list[set[int]] = [set() for _ in shapes]
    for key in resolved.keys if shapes else ():
        set_frame(context.scene, key.frame)
        graph = context.evaluated_depsgraph_get()
        for shape, faces in zip(shapes, flipped, strict=True):
            with evaluated_mesh(shape.owner.find().evaluated_get(graph)) as mesh:
                faces.update(flipped_faces(mesh, shape.triangles).tolist())
    for shape, faces in zip(shapes, flipped, strict=True):
        if faces:
            split_faces(shape.owner.find().data, sorted(faces), shape.triangles, shape.faces)


def _evaluated_meshes(
    context: bpy.types.Context, tracks: Sequence[Track], moving_sets: Sequence[MovingSet]
) -> dict[int, bpy.types.Mesh]:
    """Copies of the meshes of deforming objects, as evaluated at the first frame."""
    shapes = {
        moving_set.tracks[0]: tracks[moving_set.tracks[0]].mesh
        for moving_set in moving_sets
        if moving_set.frame is not None
    }
    meshes: dict[int, bpy.types.Mesh] = {}
    if not shapes:
        return meshes
    with open_evaluations(context, {mesh.read_from for mesh in shapes.values()}) as opened:
        for index, mesh in shapes.items():
            graph = opened.depsgraph(mesh.read_from)
            evaluated = opened.evaluated(mesh.read_from, mesh.owner)
            meshes[index] = bpy.data.meshes.new_from_object(evaluated, depsgraph=graph)
            meshes[index].name = f"{mesh.owner.name} resolved"
    return meshes


def _free(ob: bpy.types.Object) -> None:
    """Remove everything that influences the object's placement, except its own transform."""
    ob.animation_data_clear()
    ob.constraints.clear()
    ob.parent = None
    ob.delta_location, ob.delta_scale = (0, 0, 0), (1, 1, 1)
    ob.delta_rotation_euler, ob.delta_rotation_quaternion = (0, 0, 0), (1, 0, 0, 0)
    ob.rotation_mode = "QUATERNION"


def _write_placements(moving_set: MovingSet, tracks: Sequence[Track], keys: Sequence[Key]) -> None:
    for owner, index in {tracks[index].mesh.owner: index for index in reversed(moving_set.tracks)}.items():
        ob, last = owner.find(), None
        for key in keys:
            location, rotation, scale = stored_placement(
                ob, moving_set.motion(key.controls) @ tracks[index].matrices[0]
            )
            if last is not None and rotation.dot(last) < 0:
                rotation = -rotation  # the same rotation, reached by the shorter way
            last = rotation
            _place(ob, location, rotation, scale)
            for path in ("location", "rotation_quaternion", "scale"):
                ob.keyframe_insert(path, frame=key.frame)


def _write_shape(moving_set: MovingSet, track: Track, mesh: bpy.types.Mesh, keys: Sequence[Key]) -> None:
    """Write absolute shape keys, evaluated over time: the exact shape at each key, linear motion between them."""
    assert moving_set.frame is not None
    ob = track.mesh.owner.find()
    ob.modifiers.clear()
    ob.data = mesh
    _place(ob, *stored_placement(ob, track.matrices[0]))
    for key in keys:
        block = ob.shape_key_add(name=f"frame {key.frame:g}", from_mix=False)
        block.interpolation = "KEY_LINEAR"
        block.data.foreach_set("co", _local(moving_set, key.controls).ravel())
    shapes = mesh.shape_keys
    shapes.use_relative = False
    for key, block in zip(keys, shapes.key_blocks, strict=True):
        shapes.eval_time = block.frame
        shapes.keyframe_insert("eval_time", frame=key.frame)
    mesh.vertices.foreach_set("co", _local(moving_set, keys[0].controls).ravel())
    mesh.update()


def _local(moving_set: MovingSet, controls: Floats) -> Singles:
    """Stored local coordinates of all vertices of a deforming object, (n, 3)."""
    assert moving_set.frame is not None
    local = transform_points(invert(moving_set.frame), controls).astype(np.float32)
    return local if moving_set.control_seams is None else local[moving_set.control_seams.index]


def _place(ob: bpy.types.Object, location: mathutils.Vector, rotation: mathutils.Quaternion, scale: Floats) -> None:
    ob.location, ob.rotation_quaternion, ob.scale = location, rotation, np.asarray(scale)


@contextmanager
def _linear_keys(context: bpy.types.Context) -> Iterator[None]:
    """Insert new keyframes with linear interpolation inside the `with` statement."""
    edit = context.preferences.edit
    before = edit.keyframe_new_interpolation_type
    edit.keyframe_new_interpolation_type = "LINEAR"
    try:
        yield
    finally:
        edit.keyframe_new_interpolation_type = before
