# SPDX-License-Identifier: GPL-3.0-or-later
"""Three small characters with five animations that intersect, made from formulas: sines of the frame."""

from collections.abc import Callable
from math import cos, pi, radians, sin
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix

from blend_fixtures.characters import Bones, Links, make_character, make_rig

PERIOD = 24  # frames of a walk cycle

QUADRUPED: Bones = {
    "Spine": ("", (0, 0.9, 0), (0, -0.2, 0), 0.3, False),
    "Chest": ("Spine", (0, -0.2, 0), (0, -0.9, 0.05), 0.32, True),
    "Head": ("Chest", (0, -1.25, 0.5), (0, -1.75, 0.45), 0.2, False),
    **{
        f"{name}.{side}": (f"{parent}.{side}" if parent not in ("Spine", "Chest") else parent, (sign * 0.28, y, a),
                           (sign * 0.28, y, b), r, c)
        for side, sign in (("L", 1), ("R", -1))
        for name, parent, y, a, b, r, c in (
            ("Fore", "Chest", -0.44, -0.4, -0.85, 0.13, False), ("Forefoot", "Fore", -0.44, -0.85, -1.35, 0.11, True),
            ("Hind", "Spine", 0.44, -0.4, -0.85, 0.14, False), ("Hindfoot", "Hind", 0.44, -0.85, -1.35, 0.11, True),
        )
    },
}  # fmt: skip
QUADRUPED_LINKS: Links = [
    ((0, -0.9, 0.05), (0, -1.25, 0.5), 0.16),
    *(((sign * 0.15, y, 0), (sign * 0.28, y, -0.4), 0.15) for sign in (1, -1) for y in (-0.44, 0.44)),
]
ROBOT: Bones = {
    "Turntable": ("", (0, 0, 0.25), (0, 0, 0.48), 0.25, False),
    "Upper": ("Turntable", (0, 0, 0.75), (0, 0, 1.65), 0.13, False),
    "Lower": ("Upper", (0, 0, 1.85), (0, 0, 2.6), 0.11, False),
    "Tool": ("Lower", (0, 0, 2.75), (0, 0, 3.1), 0.08, False),
}


def make_walk() -> None:
    """A biped that walks on the spot; its forearms swing through its hips. A cycle."""
    rig, _ = make_character(0.11)

    def pose(frame: int) -> None:
        phase = 2 * pi * (frame - 1) / PERIOD
        for side, sign in (("L", 1), ("R", -1)):
            swing = sign * sin(phase)
            inward = 8 + 40 * cos(phase) ** 4
            _turn(rig, f"Arm.{side}", Matrix.Rotation(radians(26) * swing, 3, "X"), ("Y", sign * 76))
            _turn(rig, f"Forearm.{side}", ("Y", sign * inward), ("Z", -sign * 10))
            _turn(rig, f"Thigh.{side}", ("X", -22 * swing))
            _turn(rig, f"Shin.{side}", ("X", -12 * (1 - cos(phase + sign))))
            rig.pose.bones["Spine"].location = (0, 0.03 * cos(2 * phase), 0)

    _animate(rig, pose, PERIOD + 1)


def make_reach() -> None:
    """The same biped turns its chest and reaches across its belly with one arm, and back."""
    rig, _ = make_character(0.11)

    def pose(frame: int) -> None:
        along = 0.5 - 0.5 * cos(2 * pi * (frame - 1) / 36)
        _turn(rig, "Chest", ("Z", 14 * along))
        _turn(rig, "Arm.L", Matrix.Rotation(radians(-14 * along), 3, "X"), ("Y", 62 + 8 * along))
        _turn(rig, "Forearm.L", ("Z", -30 * along), ("Y", 72 * along))
        _turn(rig, "Arm.R", ("Y", -60 - 6 * along))
        _turn(rig, "Forearm.R", ("Z", 12 * along))

    _animate(rig, pose, 37)


def make_trot() -> None:
    """A quadruped whose hind feet step onto its forefeet. A cycle."""
    rig, _ = make_character(0.1, bones=QUADRUPED, links=QUADRUPED_LINKS)

    def pose(frame: int) -> None:
        phase = 2 * pi * (frame - 1) / 20
        for side, start in (("L", 0.0), ("R", pi)):
            fore, hind = sin(phase + start), sin(phase + start + 2.6)
            _turn(rig, f"Fore.{side}", ("X", 24 * fore))
            _turn(rig, f"Forefoot.{side}", ("X", 9 * fore))
            _turn(rig, f"Hind.{side}", ("X", 23 * hind))
            _turn(rig, f"Hindfoot.{side}", ("X", 10 * hind))
        _turn(rig, "Head", ("X", 6 * sin(2 * phase)))

    _animate(rig, pose, 21)


def make_pick() -> None:
    """A robot arm of rigid parts, turned by quaternions, swings its tool through a post and into a table."""
    rig = _make_robot()
    _add_box("Post", (0.95, 0.9, 0.84), (0.1, 0.1, 0.84))
    _add_box("Table", (1.6, -0.3, 0.5), (0.5, 0.7, 0.08))

    def pose(frame: int) -> None:
        along = 0.5 - 0.5 * cos(2 * pi * (frame - 1) / 48)
        _turn(rig, "Turntable", ("Z", 95 - 110 * along))
        _turn(rig, "Upper", ("Y", 28 + 10 * along))
        _turn(rig, "Lower", ("Y", 42 + 18 * along))
        _turn(rig, "Tool", ("Y", 25 + 14 * along))

    _animate(rig, pose, 49, "QUATERNION")


def make_rail() -> None:
    """The same robot on a rail: its object moves past a hanging lamp that it touches."""
    rig = _make_robot()
    _add_box("Lamp", (0.1, 0.35, 3.36), (0.16, 0.16, 0.3))

    def pose(frame: int) -> None:
        phase = pi * (frame - 1) / 40
        rig.location = (-1.6 + 3.2 * (0.5 - 0.5 * cos(phase)), 0, 0)
        rig.keyframe_insert("location", frame=frame)
        _turn(rig, "Turntable", ("Z", 20 * sin(4 * phase)))
        _turn(rig, "Upper", ("X", -6 + 6 * sin(4 * phase)))
        _turn(rig, "Lower", ("X", -8 - 6 * sin(4 * phase)))
        _turn(rig, "Tool", ("X", 12 * sin(4 * phase)))

    _animate(rig, pose, 41)


CLIPS: dict[str, Callable[[], None]] = {
    "walk": make_walk, "reach": make_reach, "trot": make_trot, "pick": make_pick, "rail": make_rail,
}  # fmt: skip


def make_clip(name: str) -> None:
    """Replace the open file by a clip, in Object Mode, at its first frame."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    CLIPS[name]()
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.scene.frame_set(1)


def _turn(rig: Any, name: str, *turns: Any) -> None:
    """Turn a bone: each turn is a matrix, or an axis of the armature and degrees; the last comes first."""
    matrix = Matrix.Identity(3)
    for turn in turns:
        matrix = matrix @ (Matrix.Rotation(radians(turn[1]), 3, turn[0]) if isinstance(turn, tuple) else turn)
    bone = rig.pose.bones[name]
    rest = rig.data.bones[name].matrix_local.to_3x3()
    local = rest.inverted() @ matrix @ rest
    if bone.rotation_mode == "QUATERNION":
        found = local.to_quaternion()
        bone.rotation_quaternion = found if found.dot(bone.rotation_quaternion) >= 0 else -found
    else:
        bone.rotation_euler = local.to_euler("XYZ", bone.rotation_euler)


def _animate(rig: Any, pose: Callable[[int], None], last: int, mode: str = "XYZ") -> None:
    """Key every second frame, and the last one, with Blender's own interpolation."""
    for bone in rig.pose.bones:
        bone.rotation_mode = mode
    name = "rotation_quaternion" if mode == "QUATERNION" else "rotation_euler"
    rest = {bone.name: tuple(getattr(bone, name)) for bone in rig.pose.bones}
    for frame in sorted({*range(1, last + 1, 2), last}):
        pose(frame)
        for bone in rig.pose.bones:
            if tuple(getattr(bone, name)) != rest[bone.name]:
                bone.keyframe_insert(name, frame=frame)
            if any(bone.location):
                bone.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, last


def _make_robot() -> Any:
    """A rig whose bones carry rigid capsules, and its foot."""
    rig = make_rig(bones=ROBOT)
    bpy.ops.object.mode_set(mode="OBJECT")
    for name, (_, head, tail, radius, _) in ROBOT.items():
        link = _add_capsule(name, np.array(head, float), np.array(tail, float), radius)
        link.parent, link.parent_type, link.parent_bone = rig, "BONE", name
        bpy.context.view_layer.update()
        link.matrix_parent_inverse = (rig.matrix_world @ rig.pose.bones[name].matrix).inverted() @ Matrix.Identity(4)
        link.matrix_parent_inverse = (
            Matrix.Translation((0, -rig.data.bones[name].length, 0)) @ link.matrix_parent_inverse
        )
    _add_box("Foot", (0, 0, -0.05), (0.4, 0.4, 0.05)).parent = rig
    bpy.context.view_layer.update()
    return rig


def _add_capsule(name: str, start: Any, end: Any, radius: float) -> Any:
    """A prism of eight sides with pointed ends around a segment along Z, inside its length."""
    rings = [(float(z), radius) for z in np.linspace(start[2], end[2], 4)]
    angles = np.linspace(0, 2 * pi, 8, endpoint=False)
    points = [(r * cos(a), r * sin(a), z) for z, r in rings for a in angles]
    points += [(0, 0, start[2] - 0.4 * radius), (0, 0, end[2] + 0.4 * radius)]
    sides = [
        (8 * k + i, 8 * k + (i + 1) % 8, 8 * (k + 1) + (i + 1) % 8, 8 * (k + 1) + i) for k in range(3) for i in range(8)
    ]
    ends = [((i + 1) % 8, i, 32) for i in range(8)] + [(24 + i, 24 + (i + 1) % 8, 33) for i in range(8)]
    return _add(name, points, [*sides, *ends])


def _add_box(name: str, middle: Any, half: Any) -> Any:
    corners = [tuple(np.array(middle) + np.array(half) * (x, y, z)) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return _add(name, corners, faces)


def _add(name: str, points: Any, faces: Any) -> Any:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    ob = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(ob)
    return ob
