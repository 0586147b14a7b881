# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's cloth simulation of a mesh that collides with a body, for `stiv bench cloth`."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from stiv.blender.scene.arrays import Floats, Indices, read_collection
from stiv.blender.scene.mesh_reading import evaluated_mesh

QUALITY, COLLISION_QUALITY = 10, 5  # steps per frame, at least twice Blender's defaults


@dataclass(frozen=True)
class ClothRun:
    """Positions (n, 3) of the cloth after the last frame, and the seconds of processor time of each frame."""

    cloth: Floats
    seconds: tuple[float, ...]


def simulate_cloth(
    cloth: tuple[Floats, Indices],
    body: tuple[Floats, Indices],
    body_end: Floats,
    frames: int,
    shrink: float = 0.0,
    distance: float = 1e-3,
) -> ClothRun:
    """Replace the open file by a scene with a cloth and a moving body, and simulate it.

    Meshes are positions (n, 3) and triangles (f, 3). The body moves linearly to `body_end`, (m, 3). Gravity
    is off. The cloth also collides with itself, and shrinks linearly by the fraction `shrink`.
    `distance` is the collision distance, in world units.
    """
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.use_gravity = False
    scene.frame_start, scene.frame_end = 1, frames + 1
    _add_body(body, body_end, frames, distance)
    dressed = _add_cloth(cloth, shrink, distance, frames)
    scene.frame_set(1)
    seconds = []
    for frame in range(2, frames + 2):
        begin = time.process_time()
        scene.frame_set(frame)
        seconds.append(time.process_time() - begin)
    with evaluated_mesh(dressed.evaluated_get(bpy.context.evaluated_depsgraph_get())) as mesh:
        shown: NDArray[np.float32] = read_collection(mesh.vertices, "co", 3, np.float32)
    return ClothRun(shown.astype(float), tuple(seconds))


def _add(name: str, shape: tuple[Floats, Indices]) -> bpy.types.Object:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(shape[0].tolist(), [], shape[1].tolist())
    obj = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def _add_body(body: tuple[Floats, Indices], end: Floats, frames: int, distance: float) -> None:
    obj = _add("Body", body)
    obj.shape_key_add(name="Basis")
    key = obj.shape_key_add(name="End")
    key.data.foreach_set("co", end.astype(np.float32).ravel())
    _animate(key, "value", 1.0, frames)
    obj.modifiers.new("Collision", "COLLISION")
    obj.collision.thickness_outer = max(distance, 1e-3)  # the minimum in Blender


def _add_cloth(shape: tuple[Floats, Indices], shrink: float, distance: float, frames: int) -> bpy.types.Object:
    obj = _add("Cloth", shape)
    modifier = obj.modifiers.new("Cloth", "CLOTH")
    modifier.point_cache.frame_end = frames + 1
    modifier.settings.quality = QUALITY
    if shrink:
        modifier.settings.use_dynamic_mesh = True  # otherwise the rest size stays that of the first frame
        _animate(modifier.settings, "shrink_min", shrink, frames)
    collisions = modifier.collision_settings
    collisions.collision_quality = COLLISION_QUALITY
    collisions.distance_min = max(distance, 1e-3)
    collisions.use_self_collision = True
    collisions.self_distance_min = max(distance, 1e-3)
    return obj


def _animate(owner: Any, name: str, last: float, frames: int) -> None:
    """Animate a property linearly from 0 to its last value."""
    for value, frame in ((0.0, 1), (last, frames + 1)):
        setattr(owner, name, value)
        owner.keyframe_insert(name, frame=frame)
    action = owner.id_data.animation_data.action
    curves = getattr(action, "fcurves", None) or action.layers[0].strips[0].channelbags[0].fcurves
    for point in curves[0].keyframe_points:
        point.interpolation = "LINEAR"
