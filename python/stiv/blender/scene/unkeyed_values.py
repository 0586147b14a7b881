# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps values that are not keyed yet: where Blender evaluates animated data again, keyframes would replace them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import Any

import bpy

from stiv.blender.scene.animation_curves import is_animated, keyed_paths
from stiv.blender.scene.dependencies import add_dependents
from stiv.blender.scene.followers import data_of, driving, reached


class UnkeyedValues:
    """The present values of the keyed properties of data that copies share.

    These are materials, nodes, textures and particles, and the objects that their drivers read.
    """

    def __init__(self) -> None:
        """Read the values."""
        shared = list(_shared_blocks())
        read, _ = reached([ob for block in shared for ob in driving(block)])
        blocks = [*shared, *(block for ob in read.values() for block in (ob, *data_of(ob)))]
        animated = [block for block in blocks if block.library is None and is_animated(block)]
        self._values = [(block, path, value) for block in animated for path, value in _keyed_values(block)]

    def restore(self) -> bool:
        """Write the values that differ now; False if none does."""
        changed = [each for each in self._values if _read(each[0], each[1]) != each[2]]
        for block, path, value in changed:
            _write(block, path, value)
        return bool(changed)


def _shared_blocks() -> Iterator[bpy.types.ID]:
    data = bpy.data
    for block in (*data.materials, *data.node_groups, *data.textures, *data.particles):
        yield block
        if getattr(block, "node_tree", None) is not None:
            yield block.node_tree


def _keyed_values(block: bpy.types.ID) -> Iterator[tuple[str, Any]]:
    for path in keyed_paths(block):
        with suppress(ValueError, AttributeError, KeyError):  # a path that no longer leads anywhere
            yield path, _read(block, path)


def _read(block: bpy.types.ID, path: str) -> Any:
    owner, name, is_custom = _find(block, path)
    value = owner[name] if is_custom else getattr(owner, name)
    return tuple(value) if hasattr(value, "__len__") and not isinstance(value, str) else value


def _write(block: bpy.types.ID, path: str, value: Any) -> None:
    owner, name, is_custom = _find(block, path)
    if is_custom:
        owner[name] = value
    else:
        setattr(owner, name, value)


def _find(block: bpy.types.ID, path: str) -> tuple[Any, str, bool]:
    """The owner of the property at a path, its name, and whether it is a custom property."""
    is_custom = path.endswith('"]')
    owner, _, name = path.rpartition('["' if is_custom else ".")
    if is_custom:
        name = bpy.utils.unescape_identifier(name.removesuffix('"]'))
    return (block.path_resolve(owner) if owner else block), name, is_custom


def animated_below(objects: Sequence[bpy.types.Object]) -> list[bpy.types.Object]:
    """Animated objects on which these depend, and those between."""
    found, used_by = reached(objects)
    given = {ob.session_uid for ob in objects}
    animated = {number for number, ob in found.items() if any(map(is_animated, (ob, *data_of(ob))))}
    chosen = add_dependents(animated, used_by) - given
    return [ob for number, ob in found.items() if number in chosen]


def forget_keyframes(copy: bpy.types.ID) -> None:
    """Let a copy keep its present values. Drivers stay."""
    if is_animated(copy):
        copy.animation_data.use_tweak_mode = False
        copy.animation_data.use_nla = False
        copy.animation_data.action = None
