# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a resolved animation into the open scene: keyframes of placements, and a shape key for each key of a shape.

What is written stands for itself: parents, constraints, modifiers and animation of the object that made the old motion
are taken off. Interpolation is linear.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import bpy
import mathutils
import numpy as np

from stiv.blender.animation.controls import MovingPart, stored_placement
from stiv.blender.animation.fixed_triangulation import flipped_faces, split_faces
from stiv.blender.animation.resolving import Key, Resolved
from stiv.blender.animation.tracks import Track
from stiv.blender.scene.arrays import Floats, Singles, transform_points
from stiv.blender.scene.evaluated_scene import open_evaluations
from stiv.blender.scene.mesh_reading import evaluated_mesh
from stiv.blender.verify.frame_check import go_to


def write_animation(context: bpy.types.Context, tracks: Sequence[Track], resolved: Resolved) -> None:
    """Replace the animation of all that moves. The scene ends at the first frame."""
    go_to(context.scene, resolved.keys[0].frame)
    meshes = _evaluated_meshes(context, tracks, resolved.parts)
    for part in resolved.parts:
        for index in part.tracks:
            _free(tracks[index].mesh.owner.find())
    first = 0
    with _linear_keys(context):
        for part in resolved.parts:
            rows = slice(first, first + len(part.controls))
            first = rows.stop
            keys = [Key(key.frame, key.controls[rows]) for key in resolved.keys]
            if part.frame is None:
                _write_placements(part, tracks, keys)
            else:
                _write_shape(part, tracks[part.tracks[0]], meshes[part.tracks[0]], keys)
    _fix_triangulations(context, tracks, resolved)
    go_to(context.scene, resolved.keys[0].frame)


def _fix_triangulations(context: bpy.types.Context, tracks: Sequence[Track], resolved: Resolved) -> None:
    """Splits the faces that Blender would triangulate otherwise at a key than at the first frame.

    What was solved for are the triangles of the first frame; others may intersect.
    """
    shapes = [tracks[part.tracks[0]].mesh for part in resolved.parts if part.frame is not None]
    flipped: list[set[int]] = [set() for _ in shapes]
    for key in resolved.keys if shapes else ():
        go_to(context.scene, key.frame)
        graph = context.evaluated_depsgraph_get()
        for shape, faces in zip(shapes, flipped, strict=True):
            with evaluated_mesh(shape.owner.find().evaluated_get(graph)) as mesh:
                faces.update(flipped_faces(mesh, shape.triangles).tolist())
    for shape, faces in zip(shapes, flipped, strict=True):
        if faces:
            split_faces(shape.owner.find().data, sorted(faces), shape.triangles, shape.faces)


def _evaluated_meshes(
    context: bpy.types.Context, tracks: Sequence[Track], parts: Sequence[MovingPart]
) -> dict[int, bpy.types.Mesh]:
    """Meshes of their own for what changes its shape, as the evaluation it was read in has it at the first frame."""
    shapes = {part.tracks[0]: tracks[part.tracks[0]].mesh for part in parts if part.frame is not None}
    meshes: dict[int, bpy.types.Mesh] = {}
    if not shapes:
        return meshes
    with open_evaluations(context, {mesh.read_in for mesh in shapes.values()}) as opened:
        for index, mesh in shapes.items():
            graph = opened.depsgraph(mesh.read_in)
            evaluated = opened.evaluated(mesh.read_in, mesh.owner)
            meshes[index] = bpy.data.meshes.new_from_object(evaluated, depsgraph=graph)
            meshes[index].name = f"{mesh.owner.name} resolved"
    return meshes


def _free(ob: bpy.types.Object) -> None:
    """Nothing but its own location, rotation and scale places the object from now on."""
    ob.animation_data_clear()
    ob.constraints.clear()
    ob.parent = None
    ob.delta_location, ob.delta_scale = (0, 0, 0), (1, 1, 1)
    ob.delta_rotation_euler, ob.delta_rotation_quaternion = (0, 0, 0), (1, 0, 0, 0)
    ob.rotation_mode = "QUATERNION"


def _write_placements(part: MovingPart, tracks: Sequence[Track], keys: Sequence[Key]) -> None:
    for owner, index in {tracks[index].mesh.owner: index for index in reversed(part.tracks)}.items():
        ob, last = owner.find(), None
        for key in keys:
            location, rotation, scale = stored_placement(ob, part.motion(key.controls) @ tracks[index].matrices[0])
            if last is not None and rotation.dot(last) < 0:
                rotation = -rotation  # the same rotation, and the short way there
            last = rotation
            _place(ob, location, rotation, scale)
            for path in ("location", "rotation_quaternion", "scale"):
                ob.keyframe_insert(path, frame=key.frame)


def _write_shape(part: MovingPart, track: Track, mesh: bpy.types.Mesh, keys: Sequence[Key]) -> None:
    """Absolute shape keys, run through in time: at each key exactly that shape, between two a straight way."""
    assert part.frame is not None
    ob = track.mesh.owner.find()
    ob.modifiers.clear()
    ob.data = mesh
    _place(ob, *stored_placement(ob, track.matrices[0]))
    for key in keys:
        block = ob.shape_key_add(name=f"frame {key.frame:g}", from_mix=False)
        block.interpolation = "KEY_LINEAR"
        block.data.foreach_set("co", _local(part, key.controls).ravel())
    shapes = mesh.shape_keys
    shapes.use_relative = False
    for key, block in zip(keys, shapes.key_blocks, strict=True):
        shapes.eval_time = block.frame
        shapes.keyframe_insert("eval_time", frame=key.frame)
    mesh.vertices.foreach_set("co", _local(part, keys[0].controls).ravel())
    mesh.update()


def _local(part: MovingPart, controls: Floats) -> Singles:
    """Coordinates of all vertices of a shape in its object's frame as they are stored, (n, 3)."""
    assert part.frame is not None
    local = transform_points(np.linalg.inv(part.frame).astype(np.float64), controls).astype(np.float32)
    return local if part.tied is None else local[part.tied.index]


def _place(ob: bpy.types.Object, location: mathutils.Vector, rotation: mathutils.Quaternion, scale: Floats) -> None:
    ob.location, ob.rotation_quaternion, ob.scale = location, rotation, np.asarray(scale)


@contextmanager
def _linear_keys(context: bpy.types.Context) -> Iterator[None]:
    """New keyframes are interpolated linearly for as long as this lasts."""
    edit = context.preferences.edit
    before = edit.keyframe_new_interpolation_type
    edit.keyframe_new_interpolation_type = "LINEAR"
    try:
        yield
    finally:
        edit.keyframe_new_interpolation_type = before
