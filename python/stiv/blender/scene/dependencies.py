# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects an object's modifiers and constraints look at."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Any

import bpy

from stiv.blender.scene.evaluations import VIEWPORT, is_active


@dataclass(frozen=True)
class Dependency:
    """`user` looks at object `used` through a modifier or constraint, named as in messages."""

    user: str
    used: str
    through: str


def dependencies(ob: bpy.types.Object, evaluations: Collection[str] = (VIEWPORT,)) -> Iterator[Dependency]:
    """What modifiers active in an evaluation, and constraints, of an object look at, the object itself left out."""
    for modifier in ob.modifiers:
        if any(is_active(modifier, ob, evaluation) for evaluation in evaluations):
            yield from _named(ob, f'modifier "{modifier.name}"', looked_at(modifier))
    for constraint in ob.constraints:
        if not constraint.mute:
            yield from _named(ob, f'constraint "{constraint.name}"', looked_at(constraint))


def _named(ob: bpy.types.Object, through: str, used: Iterator[Any]) -> Iterator[Dependency]:
    for other in used:
        if other != ob:
            yield Dependency(ob.name, other.name, through)


def looked_at(owner: Any) -> Iterator[bpy.types.Object]:
    """Objects that a modifier or constraint looks at."""
    values = [getattr(owner, item.identifier) for item in owner.bl_rna.properties if item.type == "POINTER"]
    if isinstance(owner, bpy.types.NodesModifier):
        values += _inputs(owner)
        values += _in_nodes(owner.node_group, set())
    if isinstance(owner, bpy.types.ArmatureConstraint):
        values += [target.target for target in owner.targets]
    for value in values:
        if isinstance(value, bpy.types.Object):
            yield value
        elif isinstance(value, bpy.types.Collection):
            yield from value.all_objects


def _inputs(modifier: bpy.types.NodesModifier) -> list[Any]:
    """What is given to a node tree: properties of its interface since Blender 5.2, before that the modifier's own."""
    given = getattr(getattr(modifier, "properties", None), "inputs", None)
    if given is None:
        return list(modifier.values())
    sockets = [getattr(given, item.identifier) for item in given.bl_rna.properties if item.type == "POINTER"]
    return [getattr(socket, "value", None) for socket in sockets]


def _in_nodes(tree: bpy.types.NodeTree | None, seen: set[str]) -> list[Any]:
    """Objects and collections chosen inside a node tree and the groups in it."""
    if tree is None or tree.name in seen:
        return []
    seen.add(tree.name)
    values = []
    for node in tree.nodes:
        values += [socket.default_value for socket in node.inputs if socket.type in ("OBJECT", "COLLECTION")]
        values += _in_nodes(getattr(node, "node_tree", None), seen)
    return values
