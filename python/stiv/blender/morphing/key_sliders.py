# SPDX-License-Identifier: GPL-3.0-or-later
"""Sliders of shape keys: which can be moved, their limits, and writing their values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.scene.references import ObjectReference, SceneChangedError

KEYED_TYPES = ("MESH", "CURVE", "SURFACE", "LATTICE")


@dataclass(frozen=True)
class KeySlider:
    """The value of a shape key.

    Attributes:
        owner: an object that has the key.
        key: name of the key.
        lower, upper: limits of the slider.
        start: value when it was read.
    """

    owner: ObjectReference
    key: str
    lower: float
    upper: float
    start: float

    @classmethod
    def read(cls, ob: bpy.types.Object, block: bpy.types.ShapeKey) -> KeySlider:
        """Read a slider."""
        start = float(np.clip(block.value, block.slider_min, block.slider_max))
        return cls(ObjectReference.of(ob), block.name, block.slider_min, block.slider_max, start)

    def write(self, value: float) -> None:
        """Set the value. Raises SceneChangedError if the key is gone."""
        self._find().value = value

    def read_value(self) -> float:
        """The present value. Raises SceneChangedError if the key is gone."""
        return float(self._find().value)

    def insert_keyframe(self) -> None:
        """Insert a keyframe for the value."""
        self._find().keyframe_insert("value")

    def _find(self) -> bpy.types.ShapeKey:
        keys = self.owner.find().data.shape_keys
        block = None if keys is None else keys.key_blocks.get(self.key)
        if block is None:
            raise SceneChangedError(f"{self.owner.name}: the shape key {self.key} is gone")
        return block


def find_sliders(
    objects: Mapping[str, Mapping[str, float]], others_yield: bool
) -> tuple[list[KeySlider], list[float], list[bool]]:
    """The sliders of a morph, the goal of each, and whether it was given one.

    objects: goals by names of object and key. others_yield: read all other sliders of these objects too, if they can be
    moved, with their present value as the goal. Raises InputError naming object and key.
    """
    sliders: list[KeySlider] = []
    goals: list[float] = []
    given: list[bool] = []
    seen: set[bpy.types.Key] = set()
    for name, values in objects.items():
        ob = _keyed_object(name)
        if ob.data.shape_keys in seen:
            raise InputError(f"{name}: it shares its shape keys with another object; name one of them")
        seen.add(ob.data.shape_keys)
        blocks = ob.data.shape_keys.key_blocks
        for key, value in values.items():
            if key not in blocks:
                raise InputError(f"{name}: it has no shape key {key}")
            if reason := _obstacle(ob, blocks[key]):
                raise InputError(f"{name}: {reason}")
            if not np.isfinite(value):
                raise InputError(f"{name}: the value of {key} is not finite")
        for block in blocks:
            is_given = block.name in values
            if is_given or (others_yield and not block.mute and not _obstacle(ob, block)):
                sliders.append(KeySlider.read(ob, block))
                goals.append(float(values[block.name]) if is_given else sliders[-1].start)
                given.append(is_given)
    if not any(given):
        raise InputError("no shape key is given a value; name at least one")
    return sliders, goals, given


def movable_keys(ob: bpy.types.Object) -> list[bpy.types.ShapeKey]:
    """The shape keys of an object whose values can be moved."""
    keys = ob.data.shape_keys
    return [] if keys is None else [block for block in keys.key_blocks if not _obstacle(ob, block)]


def _keyed_object(name: str) -> bpy.types.Object:
    ob = bpy.data.objects.get(name)
    if ob is None:
        raise InputError(f"{name}: there is no such object")
    if ob.type not in KEYED_TYPES or ob.data.shape_keys is None:
        raise InputError(f"{name}: it has no shape keys; add some")
    if not ob.data.shape_keys.use_relative:
        raise InputError(f"{name}: its shape keys are absolute; turn on Relative")
    if not ob.data.shape_keys.is_editable:
        raise InputError(f"{name}: its shape keys are linked; make a library override")
    if ob.show_only_shape_key:
        raise InputError(f"{name}: it shows only its active shape key; turn that off")
    if ob.mode == "EDIT":
        raise InputError(f"{name}: it is in Edit Mode; leave it")
    return ob


def _obstacle(ob: bpy.types.Object, block: bpy.types.ShapeKey) -> str:
    """Why the value of a key cannot be moved; empty if it can."""
    keys = ob.data.shape_keys
    if block == keys.reference_key:
        return f"{block.name} is the reference key; its value has no effect"
    path = block.path_from_id("value")
    drivers = [] if keys.animation_data is None else keys.animation_data.drivers
    if any(driver.data_path == path for driver in drivers):
        return f"the value of {block.name} has a driver; remove it"
    return ""
