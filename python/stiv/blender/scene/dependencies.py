# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the objects that an object depends on."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import bpy

from stiv.blender.scene.evaluations import VIEWPORT, is_active
from stiv.blender.scene.references import modifier_title

T = TypeVar("T", str, int, tuple[int, bool])  # objects by name or session number; a number and a kind


@dataclass(frozen=True)
class Dependency:
    """Object `user` refers to object `used` through a modifier or constraint, named as in messages.

    renders_only: the viewport does not show the modifier.
    """

    user: str
    used: str
    through: str
    renders_only: bool = False


def dependencies(ob: bpy.types.Object, evaluations: Collection[str] = (VIEWPORT,)) -> Iterator[Dependency]:
    """Other objects that active modifiers and constraints of an object refer to."""
    for owner in active_owners(ob, evaluations):
        is_modifier = isinstance(owner, bpy.types.Modifier)
        through = modifier_title(owner) if is_modifier else f'constraint "{owner.name}"'
        renders_only = is_modifier and not owner.show_viewport
        others = (each for each in referenced_objects(owner) if each != ob)
        yield from (Dependency(ob.name, each.name, through, renders_only) for each in others)


def active_owners(ob: bpy.types.Object, evaluations: Collection[str]) -> Iterator[Any]:
    """Modifiers of an object that are active in any of these evaluations, and its enabled constraints."""
    for modifier in ob.modifiers:
        if any(is_active(modifier, ob, evaluation) for evaluation in evaluations):
            yield modifier
    yield from filter(is_enabled, ob.constraints)


def is_enabled(constraint: bpy.types.Constraint) -> bool:
    """Does Blender evaluate a constraint? Not one of a type that this version does not know."""
    return not getattr(constraint, "mute", True)


def referenced_objects(owner: Any) -> Iterator[bpy.types.Object]:
    """Objects that a modifier or constraint refers to."""
    values = [getattr(owner, item.identifier) for item in owner.bl_rna.properties if item.type == "POINTER"]
    if isinstance(owner, bpy.types.NodesModifier):
        values += [value for _, _, value in node_inputs(owner)]
        values += _in_nodes(owner.node_group)
    if isinstance(owner, bpy.types.ArmatureConstraint):
        values += [target.target for target in owner.targets]
    for value in values:
        if isinstance(value, bpy.types.Object):
            yield value
        elif isinstance(value, bpy.types.Collection):
            yield from value.all_objects


def node_inputs(modifier: bpy.types.NodesModifier) -> list[tuple[Any, str, Any]]:
    """Owner, name and value of each input: properties of sockets since Blender 5.2, items of the modifier before."""
    inputs = getattr(getattr(modifier, "properties", None), "inputs", None)
    if inputs is None:
        return [(modifier, name, value) for name, value in modifier.items()]
    sockets = [getattr(inputs, item.identifier) for item in inputs.bl_rna.properties if item.type == "POINTER"]
    return [(socket, "value", getattr(socket, "value", None)) for socket in sockets]


def has_node(tree: bpy.types.NodeTree | None, kind: str) -> bool:
    """Does a node tree or one of its groups have a node of this type?"""
    return any(node.bl_idname == kind for each in _trees(tree) for node in each.nodes)


def _trees(tree: bpy.types.NodeTree | None) -> list[bpy.types.NodeTree]:
    """A node tree and its groups."""
    found, waiting = [], [tree]
    while waiting:
        each = waiting.pop()
        if each is not None and each not in found:
            found.append(each)
            waiting += [getattr(node, "node_tree", None) for node in each.nodes]
    return found


def _in_nodes(tree: bpy.types.NodeTree | None) -> list[Any]:
    """Objects and collections that a node tree and its groups refer to."""
    sockets = (socket for each in _trees(tree) for node in each.nodes for socket in node.inputs)
    return [socket.default_value for socket in sockets if socket.type in ("OBJECT", "COLLECTION")]


def shape_dependencies(ob: bpy.types.Object) -> Iterator[bpy.types.Object]:
    """Objects on which the shape or the instances of an object depend, in any evaluation."""

    for modifier in ob.modifiers:
        yield from referenced_objects(modifier)
    if ob.instance_type == "COLLECTION" and ob.instance_collection is not None:
        yield from ob.instance_collection.all_objects
    elif ob.instance_type in ("VERTS", "FACES"):
        yield from ob.children
    if ob.parent is not None and (ob.parent_type.startswith("VERTEX") or ob.parent.instance_type != "NONE"):
        yield ob.parent


def find_dependents(objects: Sequence[bpy.types.Object], names: set[str]) -> set[str]:
    """The named objects, and all that depend on them directly or indirectly."""
    users = {ob.name: {each.used for each in dependencies(ob)} for ob in objects}
    for ob in objects:
        if ob.parent is not None:
            users[ob.name].add(ob.parent.name)
    return add_dependents(names, users)


def add_dependents(start: set[T], used_by: Mapping[T, set[T]]) -> set[T]:
    """The objects of `start`, and all that use them directly or indirectly."""
    found, before = set(start), -1
    while len(found) != before:
        before = len(found)
        found |= {each for each, used in used_by.items() if used & found}
    return found


def ancestors(ob: bpy.types.Object) -> list[str]:
    """Names of the object's ancestors, nearest first."""
    return [] if ob.parent is None else [str(ob.parent.name), *ancestors(ob.parent)]
