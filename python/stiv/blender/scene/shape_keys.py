# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys of a mesh: the mix that an evaluation shows, and the keys that follow the active one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from stiv.blender.scene.arrays import Floats, Singles, read_collection
from stiv.blender.scene.evaluations import SHOWN, is_edited
from stiv.blender.scene.vertex_groups import read_group_weights


@dataclass(frozen=True, eq=False)
class KeyMix:
    """A mesh with shape keys as an evaluation shows it, before its modifiers.

    Attributes:
        positions: local positions, (m, 3), bit for bit as Blender mixes them.
        shares: motion of each vertex, (m,), for a unit motion of the active key and of the keys that follow it.
        value: the share without vertex groups; Blender's own transforms divide by it.
    """

    positions: Singles
    shares: Floats
    value: float


def read_mix(ob: bpy.types.Object, evaluation: str = SHOWN) -> KeyMix:
    """The mix of a mesh with relative shape keys; in Edit Mode as of the last `update_from_editmode`."""
    active = active_key(ob)
    if is_edited(ob) and evaluation == SHOWN and not ob.use_shape_key_edit_mode:
        return KeyMix(_points(active), np.ones(len(active.data)), 1.0)
    return _locked_mix(ob, active) if ob.show_only_shape_key else _relative_mix(ob, active)


def active_key(ob: bpy.types.Object) -> bpy.types.ShapeKey:
    """The active shape key of an object with shape keys; `active_shape_key` is None until one was chosen."""
    return ob.data.shape_keys.key_blocks[ob.active_shape_key_index]


def following_keys(ob: bpy.types.Object) -> list[int]:
    """Numbers of the active shape key, first, and of all keys that are relative to it, directly or not."""
    blocks = ob.data.shape_keys.key_blocks
    found = [ob.active_shape_key_index]
    for number in found:
        found += [k for k, each in enumerate(blocks) if each.relative_key == blocks[number] and k not in found]
    return found


def read_keys(ob: bpy.types.Object, numbers: list[int]) -> tuple[tuple[int, Singles], ...]:
    """Numbers and local positions, (m, 3), of shape keys."""
    blocks = ob.data.shape_keys.key_blocks
    return tuple((number, _points(blocks[number])) for number in numbers)


def _locked_mix(ob: bpy.types.Object, active: bpy.types.ShapeKey) -> KeyMix:
    """The active key alone; the reference key if it is muted."""
    reference = ob.data.shape_keys.reference_key
    start = _points(reference)
    if active == reference:
        return KeyMix(start, np.ones(len(start)), 1.0)
    if active.mute:
        return KeyMix(start, np.zeros(len(start)), 0.0)
    weights = _group_weights(ob, active)
    if weights is None:
        return KeyMix(_points(active), np.ones(len(start)), 1.0)
    mixed = start + weights[:, None] * (_points(active) - start)
    return KeyMix(mixed, weights.astype(np.float64), 1.0)


def _relative_mix(ob: bpy.types.Object, active: bpy.types.ShapeKey) -> KeyMix:
    """The reference key plus the differences of all keys, in Blender's order and precision."""
    keys = ob.data.shape_keys
    blocks, moving = keys.key_blocks, set(following_keys(ob))
    first = blocks.find(keys.reference_key.name)
    positions = _points(keys.reference_key)
    shares = np.full(len(positions), float(first in moving))
    for number, block in enumerate(blocks):
        if number == first or block.mute or block.value == 0:
            continue
        weights = _group_weights(ob, block)
        factors = np.float32(block.value) * (np.ones(len(positions), np.float32) if weights is None else weights)
        relative = block.relative_key
        positions += factors[:, None] * (_points(block) - _points(relative))
        shares += factors * (float(number in moving) - float(blocks.find(relative.name) in moving))
    return KeyMix(positions, shares, 1.0 if first in moving else 0.0 if active.mute else float(active.value))


def _group_weights(ob: bpy.types.Object, block: bpy.types.ShapeKey) -> NDArray[np.float32] | None:
    group = ob.vertex_groups.get(block.vertex_group) if block.vertex_group else None
    return None if group is None else read_group_weights(ob.data.vertices, group.index)


def _points(block: Any) -> Singles:
    return read_collection(block.data, "co", 3, np.float32)
