# SPDX-License-Identifier: GPL-3.0-or-later
"""Location, rotation and scale of a pose bone as scalars, with its locks and limits."""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass, replace

import bpy
import mathutils
import numpy as np

from stiv.blender.controls.motion import Motion
from stiv.blender.controls.rotations import (
    euler_angles,
    nearest_equivalent,
    nearest_rotation,
    rotation_vector,
)
from stiv.blender.scene.arrays import Floats, Indices, as_matrix
from stiv.blender.scene.references import ObjectReference, SceneChangedError

LOCATION, ROTATION, SCALE = slice(0, 3), slice(3, 7), slice(7, 10)  # of the channels of a bone, (10,)
ANGLES, VECTOR, COMPONENTS = "angles", "vector", "components"
AXIS_ANGLE = "AXIS_ANGLE"
ROTATION_NAMES = {"QUATERNION": "rotation_quaternion", AXIS_ANGLE: "rotation_axis_angle"}  # others: rotation_euler
FLIP = mathutils.Matrix.Diagonal((-1, 1, 1, 1))  # mirrors X
LONGEST_TURN = 0.2  # radians of a step: its chords leave an arc by 0.5 % of the radius


@dataclass(frozen=True)
class BoneFrame:
    """From the channels of a bone, without its constraints, to the world.

    Attributes:
        turn: (3, 3) for its rotation and scale.
        shift: (3, 3) for its location.
        origin: (3,) at location 0.
    """

    turn: Floats
    shift: Floats
    origin: Floats

    @classmethod
    def read(cls, rig: bpy.types.Object, bone: bpy.types.PoseBone) -> BoneFrame:
        """The frame in the present pose of the other bones."""

        def world(local: mathutils.Matrix) -> Floats:
            in_pose = rig.convert_space(pose_bone=bone, matrix=local, from_space="LOCAL", to_space="POSE")
            return as_matrix(rig.matrix_world @ in_pose)

        start = world(mathutils.Matrix())
        ends = [world(mathutils.Matrix.Translation(axis))[:3, 3] for axis in np.eye(3).tolist()]
        return cls(start[:3, :3], np.stack(ends, axis=1) - start[:3, 3:], start[:3, 3])

    def head(self, location: Floats) -> Floats:
        """The head of the bone in the world, (3,)."""
        return np.asarray(self.origin + self.shift @ location, np.float64)

    def location(self, head: Floats) -> Floats:
        """The location that puts the head there, (3,)."""
        return np.asarray(np.linalg.pinv(self.shift) @ (head - self.origin), np.float64)

    def turned(self, linear: Floats) -> Floats:
        """The rotation of the channels, (3, 3), that a linear map of the world causes."""
        return nearest_rotation(np.linalg.pinv(self.turn) @ linear @ self.turn)


@dataclass(frozen=True)
class StoredChannels:
    """Channels as Blender stores them; the rotation in the rotation mode of the bone."""

    location: tuple[float, ...]
    rotation: tuple[float, ...]
    scale: tuple[float, ...]

    @classmethod
    def read(cls, bone: bpy.types.PoseBone) -> StoredChannels:
        """Read a bone."""
        return cls(tuple(bone.location), tuple(_rotation(bone)), tuple(bone.scale))

    def write(self, bone: bpy.types.PoseBone) -> None:
        """Write all channels."""
        for name, values in self._rows(bone):
            _write(bone, name, values)

    def changed(self, bone: bpy.types.PoseBone) -> list[str]:
        """The properties of a bone that differ."""
        return [name for name, values in self._rows(bone) if tuple(getattr(bone, name)) != values]

    def _rows(self, bone: bpy.types.PoseBone) -> list[tuple[str, tuple[float, ...]]]:
        return [("location", self.location), (_rotation_name(bone), self.rotation), ("scale", self.scale)]


@dataclass(frozen=True, eq=False)
class MirroredBone:
    """The bone on the other side, which X-Axis Mirror moves along.

    Attributes:
        name: of the bone.
        stored: its channels at the start.
        offset: its matrix relative to the mirror image of the other bone's, (4, 4), at the start.
    """

    name: str
    stored: StoredChannels
    offset: mathutils.Matrix

    @classmethod
    def read(cls, bone: bpy.types.PoseBone, other: bpy.types.PoseBone) -> MirroredBone:
        """Read the other bone of a bone that moves."""
        offset = _mirror_image(bone).inverted_safe() @ other.matrix_basis
        return cls(other.name, StoredChannels.read(other), offset)

    def write(self, bone: bpy.types.PoseBone, rests: bool) -> None:
        """Write the mirror image of a bone; at its start, the own start to the last bit."""
        other = bone.id_data.pose.bones[self.name]
        if rests:
            self.stored.write(other)
        else:
            other.matrix_basis = _mirror_image(bone) @ self.offset


def _mirror_image(bone: bpy.types.PoseBone) -> mathutils.Matrix:
    return FLIP @ bone.matrix_basis @ FLIP


@dataclass(frozen=True, eq=False)
class BoneChannels:
    """A pose bone at the start of an edit.

    Its channels are location, rotation and scale, (10,). The rotation is

    - three angles, if the rotation mode is Euler, or an angle is locked or limited;
    - the four numbers that Blender stores, if these are locked one by one;
    - otherwise a rotation vector since the start.

    Attributes:
        rig: the armature object.
        name: of the bone.
        selected: whether the goal moves it.
        form: of the rotation.
        mode: rotation mode of the bone.
        start: channels at the start.
        stored: the same as Blender stores them.
        quaternion: rotation at the start, (4,).
        frame: from the channels to the world.
        free: the channels without a lock, ascending.
        lower, upper: limits, (10,).
        mirrored: the bone on the other side that moves along; None without X-Axis Mirror.
    """

    rig: ObjectReference
    name: str
    selected: bool
    form: str
    mode: str
    start: Floats
    stored: StoredChannels
    quaternion: tuple[float, ...]
    frame: BoneFrame
    free: Indices
    lower: Floats
    upper: Floats
    mirrored: MirroredBone | None = None

    @classmethod
    def read(cls, rig: bpy.types.Object, bone: bpy.types.PoseBone, selected: bool) -> BoneChannels:
        """Read a bone with all its free channels."""
        form = _form(bone)
        stored = StoredChannels.read(bone)
        quaternion = _quaternion(bone)
        start = np.zeros(10)
        start[LOCATION], start[SCALE] = stored.location, stored.scale
        if form == ANGLES:
            start[ROTATION][:3] = stored.rotation if _is_euler(bone) else quaternion.to_euler("XYZ")
        elif form == COMPONENTS:
            start[ROTATION] = stored.rotation
        lower, upper = _limits(bone, form)
        return cls(
            ObjectReference.of(rig), bone.name, selected, form, bone.rotation_mode, start, stored, tuple(quaternion),
            BoneFrame.read(rig, bone), _free_channels(bone, form), np.minimum(lower, start), np.maximum(upper, start),
        )  # fmt: skip

    @property
    def longest_steps(self) -> Floats:
        """Longest step of each channel, (10,)."""
        steps = np.full(10, np.inf)
        steps[ROTATION] = LONGEST_TURN / 2 if self.form == COMPONENTS else LONGEST_TURN  # quaternions have half angles
        return steps

    def limited_to(self, *ranges: slice) -> BoneChannels:
        """The bone with free channels in some ranges alone."""
        chosen = [k for k in self.free.tolist() if any(each.start <= k < each.stop for each in ranges)]
        return replace(self, free=np.array(chosen, np.int32))

    def goal(self, last: Floats, motion: Motion) -> Floats:
        """Channels, (10,), after a motion; `last` are those of the goal before."""
        found, head = self.start.copy(), self.frame.head(self.start[LOCATION])
        moved = motion.about(head[None], head) if motion.individual else motion.whole(head[None])
        found[LOCATION] = self.frame.location(moved[0])
        found[ROTATION] = self._turned(self.frame.turned(motion.linear), last[ROTATION])
        found[SCALE] *= self._factors(motion)
        return found

    def stored_goal(self, stored: StoredChannels) -> Floats:
        """Channels, (10,), of stored values in the same rotation mode."""
        found = self.start.copy()
        found[LOCATION], found[SCALE] = stored.location, stored.scale
        if stored.rotation == self.stored.rotation:
            return found
        if self.form == COMPONENTS or (self.form == ANGLES and len(stored.rotation) == 3):
            found[ROTATION][: len(stored.rotation)] = stored.rotation
            return found
        turn = _as_quaternion(self.mode, stored.rotation) @ mathutils.Quaternion(self.quaternion).inverted()
        found[ROTATION] = self._turned(np.array(turn.to_matrix(), np.float64), self.start[ROTATION])
        return found

    def free_to(self, channels: Floats, driven: Container[str]) -> BoneChannels:
        """The bone with the channels free that differ from the start, whatever is locked or limited.

        driven: names of properties that drivers set; their channels stay.
        """
        rows = ((LOCATION, "location"), (ROTATION, ROTATION_NAMES.get(self.mode, "rotation_euler")), (SCALE, "scale"))
        changed = np.zeros(10, bool)
        for which, name in rows:
            changed[which] = (channels[which] != self.start[which]) & (name not in driven)
        if self.form == VECTOR and changed[ROTATION].any():
            changed[ROTATION] = (True, True, True, False)
        return replace(
            self,
            free=np.flatnonzero(changed).astype(np.int32),
            lower=np.full(10, -np.inf),
            upper=np.full(10, np.inf),
        )

    def write(self, channels: Floats, bone: bpy.types.PoseBone) -> None:
        """Write channels, (10,), to the bone or to its copy; those of the start to the last bit."""
        _write(bone, "location", self.stored.location if self._rests(LOCATION, channels) else channels[LOCATION])
        rotation = self.stored.rotation if self._rests(ROTATION, channels) else self._rotation_of(channels[ROTATION])
        _write(bone, _rotation_name(bone), rotation)
        _write(bone, "scale", self.stored.scale if self._rests(SCALE, channels) else channels[SCALE])
        if self.mirrored is not None:
            self.mirrored.write(bone, bool((channels == self.start).all()))

    def property_of(self, channels: slice, bone: bpy.types.PoseBone) -> str:
        """The property of a bone with a range of its channels."""
        return {LOCATION.start: "location", SCALE.start: "scale"}.get(channels.start, _rotation_name(bone))

    def find(self) -> bpy.types.PoseBone:
        """The bone at present. Raises SceneChangedError if it is gone."""
        pose = self.rig.find().pose
        bone = None if pose is None else pose.bones.get(self.name)
        if bone is None:
            raise SceneChangedError(f"{self.rig.name}: the bone {self.name} is gone")
        return bone

    def _rests(self, which: slice, channels: Floats) -> bool:
        return bool((channels[which] == self.start[which]).all())

    def _turned(self, turn: Floats, last: Floats) -> Floats:
        """Rotation channels, (4,), of the start after a rotation, (3, 3)."""
        result = self.start[ROTATION].copy()
        if self.form == VECTOR:
            result[:3] = nearest_equivalent(rotation_vector(turn), last[:3])
        elif self.form == ANGLES:
            result[:3] = euler_angles(turn @ self._start_matrix, self.order, last[:3])
        else:
            quaternion = mathutils.Matrix((turn @ self._start_matrix).tolist()).to_quaternion()
            found = np.array(self._stored_from(quaternion))
            result[:] = found if self.mode == AXIS_ANGLE or found @ last >= 0 else -found
        return result

    def _factors(self, motion: Motion) -> Floats:
        """Factors of the scale, (3,)."""
        if motion.is_uniform:
            return np.full(3, motion.linear[0, 0])
        axes = nearest_rotation(self.frame.turn @ self._start_matrix)
        factors: Floats = np.einsum("ki,kl,li->i", axes, motion.linear, axes)
        return factors

    @property
    def order(self) -> str:
        """Order of the angles."""
        return "XYZ" if self.mode in ("QUATERNION", AXIS_ANGLE) else self.mode

    @property
    def _start_matrix(self) -> Floats:
        return np.array(mathutils.Quaternion(self.quaternion).to_matrix(), np.float64)

    def _rotation_of(self, channels: Floats) -> Sequence[float]:
        """The rotation as Blender stores it, from its channels, (4,)."""
        if self.form == COMPONENTS or (self.form == ANGLES and len(self.stored.rotation) == 3):
            return tuple(channels[: len(self.stored.rotation)])
        if self.form == ANGLES:
            quaternion = mathutils.Euler(channels[:3].tolist(), "XYZ").to_quaternion()
        else:
            angle = float(np.linalg.norm(channels[:3]))
            axis = mathutils.Vector(channels[:3].tolist())
            quaternion = mathutils.Quaternion(axis, angle) @ mathutils.Quaternion(self.quaternion)
        return self._stored_from(quaternion)

    def _stored_from(self, quaternion: mathutils.Quaternion) -> Sequence[float]:
        """A rotation as quaternion, or as angle and axis."""
        if self.mode != AXIS_ANGLE:
            return tuple(quaternion)
        axis, angle = quaternion.to_axis_angle()
        return (angle, *axis)


def _is_euler(bone: bpy.types.PoseBone) -> bool:
    return bone.rotation_mode not in ("QUATERNION", AXIS_ANGLE)


def _rotation_name(bone: bpy.types.PoseBone) -> str:
    return ROTATION_NAMES.get(bone.rotation_mode, "rotation_euler")


def _rotation(bone: bpy.types.PoseBone) -> Sequence[float]:
    found: Sequence[float] = getattr(bone, _rotation_name(bone))
    return found


def _quaternion(bone: bpy.types.PoseBone) -> mathutils.Quaternion:
    return _as_quaternion(bone.rotation_mode, tuple(_rotation(bone)))


def _as_quaternion(mode: str, stored: Sequence[float]) -> mathutils.Quaternion:
    """A rotation as Blender stores it in a rotation mode."""
    if mode == "QUATERNION":
        return mathutils.Quaternion(stored)
    if mode == AXIS_ANGLE:
        angle, *axis = stored
        return mathutils.Quaternion(axis, angle)
    return mathutils.Euler(stored, mode).to_quaternion()


def _form(bone: bpy.types.PoseBone) -> str:
    if _is_euler(bone):
        return ANGLES
    if bone.lock_rotations_4d and (bone.lock_rotation_w or any(bone.lock_rotation)):
        return COMPONENTS
    return ANGLES if any(bone.lock_rotation) or any(_limited_axes(bone)) else VECTOR


def _limited_axes(bone: bpy.types.PoseBone) -> list[bool]:
    return [getattr(bone, f"use_ik_limit_{axis}") for axis in "xyz"]


def _limits(bone: bpy.types.PoseBone, form: str) -> tuple[Floats, Floats]:
    """Limits of the channels, (10,) each: those of inverse kinematics, for angles."""
    lower, upper = np.full(10, -np.inf), np.full(10, np.inf)
    for k, axis in enumerate("xyz" if form == ANGLES else ""):
        if getattr(bone, f"use_ik_limit_{axis}"):
            lower[3 + k], upper[3 + k] = getattr(bone, f"ik_min_{axis}"), getattr(bone, f"ik_max_{axis}")
    return lower, upper


def _free_channels(bone: bpy.types.PoseBone, form: str) -> Indices:
    """The channels without a lock, ascending. A connected bone has no location of its own."""
    is_connected = bone.parent is not None and bone.bone.use_connect
    location = [not (is_connected or locked) for locked in bone.lock_location]
    angles = [not locked for locked in bone.lock_rotation]
    rotation = [not bone.lock_rotation_w, *angles] if form == COMPONENTS else [*angles, False]
    scale = [not locked for locked in bone.lock_scale]
    return np.flatnonzero([*location, *rotation, *scale]).astype(np.int32)


def _write(bone: bpy.types.PoseBone, name: str, values: Sequence[float] | Floats) -> None:
    """Write a channel of a bone, unless it has these values: each write makes Blender evaluate the rig."""
    single = np.asarray(values, np.float32)
    if not np.array_equal(np.array(getattr(bone, name), np.float32), single):
        setattr(bone, name, single.tolist())
