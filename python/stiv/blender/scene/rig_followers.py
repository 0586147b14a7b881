# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the objects that move with rigs, and drivers that depend on what they drive."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

import bpy

from stiv.blender.scene.dependencies import add_dependents, dependencies, referenced_objects
from stiv.blender.scene.evaluations import RENDER, VIEWPORT

BONE = re.compile(r'pose\.bones\["((?:[^"\\]|\\.)*)"\]')
INDEX = re.compile(r"\[\d+\]$")
Node = tuple[str, str]  # name of an object; of one of its bones, a data path, or "" for the object itself


def find_followers(scene: bpy.types.Scene, rigs: set[str]) -> set[str]:
    """Names of the rigs, and of all objects that depend on them directly or indirectly."""
    users = {ob.name: set(_used(ob)) for ob in scene.objects}
    return add_dependents(rigs, users)


def _used(ob: bpy.types.Object) -> Iterator[str]:
    """Names of the objects on which an object depends."""
    yield from (each.used for each in dependencies(ob, (VIEWPORT, RENDER)))
    if ob.parent is not None:
        yield ob.parent.name
    for constraint in _bone_constraints(ob):
        yield from (other.name for other in referenced_objects(constraint))
    for target in _driver_targets(ob):
        if isinstance(target.id, bpy.types.Object):
            yield target.id.name


def _bone_constraints(ob: bpy.types.Object) -> Iterator[bpy.types.Constraint]:
    if ob.pose is not None:
        yield from (each for bone in ob.pose.bones for each in bone.constraints if not each.mute)


def _driver_targets(ob: bpy.types.Object) -> Iterator[bpy.types.DriverTarget]:
    for owner in (ob, ob.data, getattr(ob.data, "shape_keys", None)):
        yield from find_driver_targets(owner)


def find_driver_targets(owner: bpy.types.ID | None) -> Iterator[bpy.types.DriverTarget]:
    """The targets of the drivers of an ID."""
    animation = getattr(owner, "animation_data", None)
    for curve in () if animation is None else animation.drivers:
        yield from (target for variable in curve.driver.variables for target in variable.targets)


def find_driver_cycle(rig: bpy.types.Object) -> str:
    """The bone, or the data path, of a driver of a rig that depends on what it drives; empty if there is none."""
    graph: dict[Node, set[Node]] = {}
    drivers = [] if rig.animation_data is None else list(rig.animation_data.drivers)
    for bone in rig.pose.bones:
        node = (rig.name, bone.name)
        graph.setdefault(node, set())
        if bone.parent is not None:
            graph[node].add((rig.name, bone.parent.name))
        for constraint in bone.constraints:
            target = getattr(constraint, "target", None)
            if not constraint.mute and target == rig and getattr(constraint, "subtarget", ""):
                graph[node].add((rig.name, constraint.subtarget))
    for curve in drivers:
        driven = _driven_by(rig, curve)
        if found := BONE.match(curve.data_path):
            graph.setdefault((rig.name, found.group(1)), set()).add(driven)
        for variable in curve.driver.variables:
            for target in variable.targets:
                if target.id == rig:
                    graph.setdefault(driven, set()).add(_read_by(rig.name, variable, target))
    cyclic = (curve.data_path for curve in drivers if _reaches(_driven_by(rig, curve), graph))
    path = next(cyclic, "")
    found = BONE.match(path)
    return path if found is None else found.group(1)


def _driven_by(rig: bpy.types.Object, curve: bpy.types.FCurve) -> Node:
    """The property that a driver writes."""
    return rig.name, f"{curve.data_path}[{curve.array_index}]"


def _read_by(rig: str, variable: bpy.types.DriverVariable, target: bpy.types.DriverTarget) -> Node:
    """The property or bone that a target of a driver reads."""
    if variable.type != "SINGLE_PROP":
        return rig, target.bone_target
    return rig, target.data_path if INDEX.search(target.data_path) else f"{target.data_path}[0]"


def _reaches(start: Node, graph: Mapping[Node, set[Node]]) -> bool:
    """Does a node depend on itself?"""
    seen: set[Node] = set()
    waiting = list(graph.get(start, ()))
    while waiting:
        node = waiting.pop()
        if node == start:
            return True
        if node not in seen:
            seen.add(node)
            waiting += graph.get(node, ())
    return False
