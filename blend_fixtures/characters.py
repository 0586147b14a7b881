# SPDX-License-Identifier: GPL-3.0-or-later
"""Small characters made by script: capsules around bones, joined to one closed mesh, and weights by distance."""

from typing import Any

import bmesh
import bpy
import numpy as np

# bone: parent, head, tail, radius of the body, connected
Bones = dict[str, tuple[str, Any, Any, float, bool]]
BONES: Bones = {
    "Spine": ("", (0, 0, 0), (0, 0, 0.7), 0.34, False),
    "Chest": ("Spine", (0, 0, 0.7), (0, 0, 1.3), 0.36, True),
    "Head": ("Chest", (0, 0, 1.6), (0, 0, 2.0), 0.24, False),
    **{
        f"{name}.{side}": (
            f"{parent}.{side}" if parent != "Chest" else parent,
            (sign * a, 0, z),
            (sign * b, 0, z),
            r,
            c,
        )
        for side, sign in (("L", 1), ("R", -1))
        for name, parent, a, b, z, r, c in (
            ("Arm", "Chest", 0.5, 1.0, 1.35, 0.14, False),
            ("Forearm", "Arm", 1.0, 1.5, 1.35, 0.12, True),
        )
    },
    **{
        f"{name}.{side}": (
            f"{parent}.{side}" if parent != "Spine" else parent,
            (sign * 0.2, 0, a),
            (sign * 0.2, 0, b),
            r,
            c,
        )
        for side, sign in (("L", 1), ("R", -1))
        for name, parent, a, b, r, c in (
            ("Thigh", "Spine", -0.3, -0.9, 0.16, False),
            ("Shin", "Thigh", -0.9, -1.5, 0.13, True),
        )
    },
}

# ends and radii of the capsules between the body and neck, shoulders and hips
Links = list[tuple[Any, Any, float]]
LINKS: Links = [
    ((0, 0, 1.3), (0, 0, 1.6), 0.14),
    *(((0, 0, 1.3), (sign * 0.5, 0, 1.35), 0.15) for sign in (1, -1)),
    *(((sign * 0.1, 0, 0), (sign * 0.2, 0, -0.3), 0.17) for sign in (1, -1)),
]


def make_rig(name: str = "Rig", bones: Bones = BONES) -> Any:
    """An armature with these bones, in Pose Mode."""
    rig = _add(name, bpy.data.armatures.new(name))
    bpy.context.view_layer.objects.active = rig
    rig.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    for bone, (parent, head, tail, _, connected) in bones.items():
        made = rig.data.edit_bones.new(bone)
        made.head, made.tail = head, tail
        if parent:
            made.parent, made.use_connect = rig.data.edit_bones[parent], connected
    bpy.ops.object.mode_set(mode="POSE")
    return rig


def make_character(
    voxel: float = 0.07, name: str = "Body", bones: Bones = BONES, links: Links = LINKS
) -> tuple[Any, Any]:
    """The rig, in Pose Mode, and its body."""
    rig = make_rig(bones=bones)
    body = _add(name, _skin(voxel, bones, links))
    points = np.array([vertex.co for vertex in body.data.vertices])
    for bone, weights in zip(bones, _weights(points, bones), strict=True):
        group = body.vertex_groups.new(name=bone)
        for number in np.flatnonzero(weights).tolist():
            group.add([number], float(weights[number]), "REPLACE")
    body.parent = rig
    body.modifiers.new("Armature", "ARMATURE").object = rig
    bpy.context.view_layer.update()
    return rig, body


def _add(name: str, data: Any) -> Any:
    ob = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(ob)
    return ob


def _distances(points: np.ndarray, bones: Bones) -> np.ndarray:
    """From the bones, (b, n)."""
    rows = []
    for _, head, tail, _, _ in bones.values():
        start, along = np.array(head, float), np.array(tail, float) - head
        at = np.clip((points - start) @ along / (along @ along), 0, 1)
        rows.append(np.linalg.norm(points - start - at[:, None] * along, axis=1))
    return np.array(rows)


def _weights(points: np.ndarray, bones: Bones) -> np.ndarray:
    """Of the bones at points, (b, n): the nearest relative to the radius of the body, blended at joints."""
    radii = np.array([radius for *_, radius, _ in bones.values()])[:, None]
    depth = _distances(points, bones) / radii
    weights = np.exp(-8 * (depth - depth.min(axis=0)))
    weights[weights < 0.02] = 0
    return np.asarray(weights / weights.sum(axis=0))


def _skin(voxel: float, bones: Bones, links: Links) -> Any:
    """Capsules around the bones and along the links, as one closed mesh."""
    capsules = [*((head, tail, radius) for _, head, tail, radius, _ in bones.values()), *links]
    ends = [(np.array(start, float), np.array(end, float), radius) for start, end, radius in capsules]
    ball = bmesh.new()
    bmesh.ops.create_icosphere(ball, subdivisions=3, radius=1)
    unit = np.array([vertex.co for vertex in ball.verts])
    corners = np.array([[vertex.index for vertex in face.verts] for face in ball.faces])
    ball.free()
    vertices, faces = [], []
    for start, end, radius in ends:
        for share in np.linspace(0, 1, 1 + int(np.ceil(np.linalg.norm(end - start) / (0.3 * radius)))):
            faces.append(corners + len(unit) * len(vertices))
            vertices.append(radius * unit + start + share * (end - start))
    bpy.ops.object.mode_set(mode="OBJECT")
    mesh = bpy.data.meshes.new("Capsules")
    mesh.from_pydata(np.concatenate(vertices).tolist(), [], np.concatenate(faces).tolist())
    whole = _add("Capsules", mesh)
    remesh = whole.modifiers.new("Remesh", "REMESH")
    remesh.mode, remesh.voxel_size = "VOXEL", voxel
    bpy.context.view_layer.update()
    made = bpy.data.meshes.new_from_object(whole.evaluated_get(bpy.context.evaluated_depsgraph_get()))
    bpy.data.objects.remove(whole)
    bpy.context.view_layer.objects.active = bpy.data.objects["Rig"]
    bpy.ops.object.mode_set(mode="POSE")
    return made


def select_bones(rig: Any, *names: str) -> None:
    """Select these bones alone; the first becomes active."""
    for bone in rig.pose.bones:
        owner = bone if hasattr(bone, "select") else bone.bone
        owner.select = bone.name in names
    rig.data.bones.active = rig.data.bones[names[0]] if names else None
    bpy.context.view_layer.update()
