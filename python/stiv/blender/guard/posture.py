# SPDX-License-Identifier: GPL-3.0-or-later
"""Pose bones and shape key values of an object, as plain values: compared, and put back."""

from dataclasses import dataclass

import bpy

from stiv.blender.controls.object_transform import ROTATION_PROPERTIES


@dataclass(frozen=True)
class Posture:
    """What shapes an object beside its controls.

    Attributes:
        bones: for each pose bone its name, location, rotation property, rotation and scale.
        keys: for each shape key its name and value.
    """

    bones: tuple[tuple[str, tuple[float, ...], str, tuple[float, ...], tuple[float, ...]], ...] = ()
    keys: tuple[tuple[str, float], ...] = ()

    def restore(self, ob: bpy.types.Object) -> None:
        """Write it back; bones and keys that are gone are left out."""
        for name, location, rotation_property, rotation, scale in self.bones:
            bone = ob.pose.bones.get(name) if ob.pose is not None else None
            if bone is not None:
                bone.location, bone.scale = location, scale
                setattr(bone, rotation_property, rotation)
        keys = getattr(ob.data, "shape_keys", None)
        for name, value in self.keys:
            key = keys.key_blocks.get(name) if keys is not None else None
            if key is not None:
                key.value = value


def read_posture(ob: bpy.types.Object) -> Posture:
    """Pose and shape key values as they are now; empty for objects without."""
    keys = getattr(ob.data, "shape_keys", None)
    return Posture(
        tuple(map(_read_bone, ob.pose.bones)) if ob.pose is not None else (),
        tuple((key.name, key.value) for key in keys.key_blocks) if keys is not None else (),
    )


def _read_bone(
    bone: bpy.types.PoseBone,
) -> tuple[str, tuple[float, ...], str, tuple[float, ...], tuple[float, ...]]:
    rotation = ROTATION_PROPERTIES.get(bone.rotation_mode, "rotation_euler")
    return bone.name, tuple(bone.location), rotation, tuple(getattr(bone, rotation)), tuple(bone.scale)
