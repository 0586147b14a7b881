# SPDX-License-Identifier: GPL-3.0-or-later
"""Bones and objects whose keyframes may change: their location and rotation, and corrections of these."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

import bpy
import mathutils
import numpy as np

from stiv import InputError
from stiv.blender.controls.bone_channels import AXIS_ANGLE
from stiv.blender.controls.bone_set import check_rig
from stiv.blender.controls.rotations import rotation_matrix, rotation_vector
from stiv.blender.scene.animation_curves import own_curves
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.references import ObjectReference

ROTATIONS = {"QUATERNION": "rotation_quaternion", AXIS_ANGLE: "rotation_axis_angle"}


@dataclass(frozen=True)
class Limits:
    """How much the animation may change.

    Attributes:
        turn: largest change of an angle, degrees.
        move: largest change along an axis, in the units of the location; infinite: a tenth of the surface's size.
        names: patterns of the bones and objects that may change, each with its own largest angle or None; empty: all.
        hold: names of objects that keep their animation.
    """

    turn: float
    move: float
    names: Mapping[str, float | None]
    hold: Collection[str]

    def turn_of(self, name: str) -> float | None:
        """Largest change of the angles of a bone or an object, degrees; None if it keeps its animation."""
        if not self.names:
            return self.turn
        found = [turn for pattern, turn in self.names.items() if fnmatchcase(name, pattern)]
        return None if not found else self.turn if found[-1] is None else found[-1]


@dataclass(frozen=True)
class Values:
    """Location and rotation as Blender stores them."""

    location: tuple[float, ...]
    rotation: tuple[float, ...]


@dataclass(frozen=True)
class AnimatedPart:
    """A bone, or an object (`bone` is ""), that keyframes move.

    Its correction adds to the location along `location`, and to the Euler angles of `rotation`; quaternions turn by a
    rotation vector about their own axes.

    Attributes:
        owner: the object with the action.
        location, rotation: axes that may change, ascending.
        most: largest amounts of the correction, (k,); infinite: not chosen.
    """

    owner: ObjectReference
    bone: str
    mode: str
    location: tuple[int, ...]
    rotation: tuple[int, ...]
    most: tuple[float, ...]

    @property
    def count(self) -> int:
        """Number of values of a correction."""
        return len(self.location) + len(self.rotation)

    @property
    def name(self) -> str:
        """The bone or the object."""
        return self.bone or self.owner.name

    @property
    def properties(self) -> tuple[str, ...]:
        """The animated properties that a correction changes."""
        return (*(("location",) if self.location else ()), *((rotation_name(self.mode),) if self.rotation else ()))

    def find(self) -> bpy.types.PoseBone | bpy.types.Object:
        """The bone or the object at present."""
        ob = self.owner.find()
        return ob.pose.bones[self.bone] if self.bone else ob

    def path(self, name: str) -> str:
        """Data path of a property."""
        return f'pose.bones["{bpy.utils.escape_identifier(self.bone)}"].{name}' if self.bone else name

    def read(self) -> Values:
        """Location and rotation at present."""
        found = self.find()
        return Values(tuple(found.location), tuple(getattr(found, rotation_name(self.mode))))

    def corrected(self, base: Values, correction: Floats) -> Values:
        """Values after a correction, (k,)."""
        if not correction.any():
            return base
        location = np.array(base.location)
        location[list(self.location)] += correction[: len(self.location)]
        turn = correction[len(self.location) :]
        return Values(tuple(location.tolist()), self._turned(base.rotation, turn) if turn.any() else base.rotation)

    def correction_between(self, base: Values, one: Values, other: Values, fraction: float) -> Floats:
        """The correction of a base, (k,), that gives stored values between two others, as linear keys do."""
        weights, pairs = (1 - fraction, fraction), zip(_stored(one), _stored(other), strict=True)
        mean = Values(*(tuple(np.average(pair, axis=0, weights=weights).tolist()) for pair in pairs))
        location = (np.array(mean.location) - base.location)[list(self.location)]
        if len(base.rotation) == 3:
            turn = (np.array(mean.rotation) - base.rotation)[list(self.rotation)]
        elif self.rotation:
            after = quaternion_of(self.mode, base.rotation).inverted() @ quaternion_of(self.mode, mean.rotation)
            turn = rotation_vector(np.array(after.to_matrix(), np.float64))
        else:
            turn = np.empty(0)
        return np.concatenate([location, turn])

    def write(self, values: Values) -> None:
        """Write values, without a keyframe."""
        found = self.find()
        _write(found, "location", values.location)
        _write(found, rotation_name(self.mode), values.rotation)

    def _turned(self, stored: Sequence[float], turn: Floats) -> tuple[float, ...]:
        if len(stored) == 3:
            angles = np.array(stored)
            angles[list(self.rotation)] += turn
            return tuple(angles.tolist())
        before = quaternion_of(self.mode, stored)
        after = before @ mathutils.Matrix(rotation_matrix(turn).tolist()).to_quaternion()
        if self.mode != AXIS_ANGLE:
            return tuple(after if after.dot(before) >= 0 else -after)
        axis, angle = after.to_axis_angle()
        if axis.dot(mathutils.Vector(stored[1:])) < 0:
            axis, angle = -axis, -angle
        return (angle, *axis)


def _stored(values: Values) -> tuple[tuple[float, ...], tuple[float, ...]]:
    return values.location, values.rotation


def rotation_name(mode: str) -> str:
    """The property of a rotation mode."""
    return ROTATIONS.get(mode, "rotation_euler")


def quaternion_of(mode: str, stored: Sequence[float]) -> mathutils.Quaternion:
    """A stored rotation as a quaternion of length 1."""
    if mode == "QUATERNION":
        return mathutils.Quaternion(stored).normalized()
    if mode == AXIS_ANGLE:
        return mathutils.Quaternion(stored[1:], stored[0])
    return mathutils.Euler(stored, mode).to_quaternion()


def turn_between(mode: str, one: Values, other: Values) -> Floats:
    """Rotation vector from one rotation to another one, (3,), radians."""
    turn = quaternion_of(mode, other.rotation) @ quaternion_of(mode, one.rotation).inverted()
    return rotation_vector(np.array(turn.to_matrix(), np.float64))


def find_animated_parts(scene: bpy.types.Scene, frames: Sequence[int], limits: Limits) -> list[AnimatedPart]:
    """The animated bones and objects that may change. Raises InputError by name."""
    animated = [ob for ob in scene.objects if ob.name not in limits.hold and _has_keys(ob)]
    _check_known(scene, limits.hold)
    found = [part for ob in animated for part in _parts_of(ob, limits)]
    known = {part.name for ob in animated for part in _parts_of(ob, Limits(1.0, 1.0, {}, ()))}
    for pattern in limits.names:
        if not any(fnmatchcase(name, pattern) for name in known):
            raise InputError(f"{pattern}: no keyframes move a bone or object of this name")
    if not found:
        raise InputError("no keyframes move a bone or an object; use --write shapes")
    for ob in {part.owner: part.owner.find() for part in found}.values():
        _check_owner(ob, frames)
    return found


def _check_known(scene: bpy.types.Scene, names: Iterable[str]) -> None:
    for name in names:
        if name not in scene.objects:
            raise InputError(f"{name}: there is no object of this name; remove it from --hold")


def _has_keys(ob: bpy.types.Object) -> bool:
    return ob.animation_data is not None and (ob.animation_data.action is not None or _has_strips(ob))


def _has_strips(ob: bpy.types.Object) -> bool:
    tracks = ob.animation_data.nla_tracks if ob.animation_data.use_nla else ()
    return any(not track.mute and any(not strip.mute for strip in track.strips) for track in tracks)


def _check_owner(ob: bpy.types.Object, frames: Sequence[int]) -> None:
    """Refuse actions that cannot be changed. Raises InputError by name."""
    if ob.type == "ARMATURE":
        check_rig(ob)
    if not ob.is_editable or (ob.override_library is not None and ob.override_library.is_system_override):
        raise InputError(f"{ob.name}: it is linked; make a library override of it")
    action = ob.animation_data.action
    if not action.is_editable:
        raise InputError(f"{ob.name}: its action is linked; make it local")
    if _has_strips(ob):
        raise InputError(f"{ob.name}: NLA strips move it; bake them to an action")
    times = [key.co[0] for curve in own_curves(ob) for key in curve.keyframe_points]
    if not times or min(times) > frames[-1] or max(times) < frames[0]:
        raise InputError(f"{ob.name}: it has no keyframes in frames {frames[0]} to {frames[-1]}")


def _parts_of(ob: bpy.types.Object, limits: Limits) -> Iterator[AnimatedPart]:
    if ob.animation_data.action is None:
        if _has_strips(ob) and limits.turn_of(ob.name) is not None:
            raise InputError(f"{ob.name}: NLA strips move it; bake them to an action")
        return
    keyed = {curve.data_path for curve in own_curves(ob) if not curve.mute and len(curve.keyframe_points)}
    driven = {curve.data_path for curve in ob.animation_data.drivers if not curve.mute}
    for holder in (ob, *(ob.pose.bones if ob.pose is not None else ())):
        turn = limits.turn_of(holder.name)
        if turn is None:
            continue
        part = _part(ob, holder, keyed - driven, np.radians(turn), limits.move)
        if part.count:
            yield part


def _part(ob: bpy.types.Object, holder: Any, keyed: Collection[str], turn: float, move: float) -> AnimatedPart:
    """The part with the channels of its animated properties that have no lock."""
    bone = "" if holder is ob else holder.name
    part = AnimatedPart(ObjectReference.of(ob), bone, holder.rotation_mode, (), (), ())
    is_fixed = bool(bone) and holder.parent is not None and holder.bone.use_connect
    location = [k for k in range(3) if not (is_fixed or holder.lock_location[k])]
    rotation = [k for k in range(3) if not holder.lock_rotation[k]]
    if rotation_name(part.mode) != "rotation_euler" and (len(rotation) < 3 or holder.lock_rotation_w):
        rotation = []  # a lock of single numbers of a quaternion
    location = location if part.path("location") in keyed else []
    rotation = rotation if part.path(rotation_name(part.mode)) in keyed else []
    most = (move,) * len(location) + (float(turn),) * len(rotation)
    return AnimatedPart(part.owner, bone, part.mode, tuple(location), tuple(rotation), most)


def _write(holder: Any, name: str, values: Sequence[float]) -> None:
    """Write a property unless it has these values: each write makes Blender evaluate the object."""
    if not np.array_equal(np.array(getattr(holder, name), np.float32), np.asarray(values, np.float32)):
        setattr(holder, name, values)
