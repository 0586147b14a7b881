# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds drivers that depend on what they drive, directly or through bones, constraints and other data."""

from __future__ import annotations

import re
from collections.abc import Iterator

import bpy

from stiv.blender.scene.dependencies import is_enabled, referenced_objects

BONE = re.compile(r'pose\.bones\["((?:[^"\\]|\\.)*)"\]')
INDEX = re.compile(r"\[\d+\]$")
TRANSFORMS = ("location", "rotation", "scale", "delta_")  # beginnings of the data paths that move an object
Node = tuple[str, str, str]  # type and name of an ID; a data path, "bone" and its name, or "" for an object's transform


def find_driver_cycle(rig: bpy.types.Object) -> tuple[str, str]:
    """The data, and its bone or data path, of a driver that depends on itself and that a rig depends on.

    Two empty texts if there is none.
    """
    graph = _Graph(rig)
    for owner, curve in graph.drivers:
        if graph.reaches_itself(_driven(owner, curve)):
            found = BONE.match(curve.data_path)
            return owner.name, curve.data_path if found is None else found.group(1)
    return "", ""


class _Graph:
    """Edges from each bone, object and driven property to those that it reads, for all data on which a rig depends.

    Attributes:
        drivers: all of this data.
    """

    def __init__(self, rig: bpy.types.Object) -> None:
        self.drivers: list[tuple[bpy.types.ID, bpy.types.FCurve]] = []
        self._reads: dict[Node, set[Node]] = {}
        seen: set[bpy.types.ID] = set()
        waiting: list[bpy.types.ID] = [rig]
        while waiting:
            owner = waiting.pop()
            if owner in seen:
                continue
            seen.add(owner)
            waiting += self._add_object(owner) if isinstance(owner, bpy.types.Object) else []
            waiting += self._add_drivers(owner)

    def reaches_itself(self, start: Node) -> bool:
        """Does a node depend on itself?"""
        seen: set[Node] = set()
        waiting = list(self._reads.get(start, ()))
        while waiting:
            node = waiting.pop()
            if node == start:
                return True
            if node not in seen:
                seen.add(node)
                waiting += self._reads.get(node, ())
        return False

    def _add(self, node: Node, read: Node) -> None:
        self._reads.setdefault(node, set()).add(read)

    def _add_drivers(self, owner: bpy.types.ID) -> Iterator[bpy.types.ID]:
        """Add the drivers of some data; returns the data that they read."""
        animation = getattr(owner, "animation_data", None)
        for curve in () if animation is None else animation.drivers:
            self.drivers.append((owner, curve))
            driven = _driven(owner, curve)
            if found := BONE.match(curve.data_path):
                self._add(_bone(owner, found.group(1)), driven)
            elif curve.data_path.startswith((*TRANSFORMS, "constraints")):
                self._add(_key(owner, ""), driven)
            for variable in curve.driver.variables:
                for target in variable.targets:
                    if target.id is not None:
                        self._add(driven, _read(variable, target))
                        yield target.id

    def _add_object(self, ob: bpy.types.Object) -> Iterator[bpy.types.ID]:
        """Add parent, constraints and bones of an object; returns the objects that it reads."""
        here = _key(ob, "")
        if ob.parent is not None:
            on_bone = ob.parent_type == "BONE"
            self._add(here, _bone(ob.parent, ob.parent_bone) if on_bone else _key(ob.parent, ""))
            yield ob.parent
        yield from self._add_constraints(here, ob.constraints)
        for bone in () if ob.pose is None else ob.pose.bones:
            if bone.parent is not None:
                self._add(_bone(ob, bone.name), _bone(ob, bone.parent.name))
            yield from self._add_constraints(_bone(ob, bone.name), bone.constraints)

    def _add_constraints(self, node: Node, constraints: bpy.types.bpy_prop_collection) -> Iterator[bpy.types.ID]:
        for constraint in constraints:
            if not is_enabled(constraint):
                continue
            subtarget = getattr(constraint, "subtarget", "")
            for other in referenced_objects(constraint):
                is_bone = other == getattr(constraint, "target", None) and subtarget and other.pose is not None
                self._add(node, _bone(other, subtarget) if is_bone else _key(other, ""))
                yield other


def _key(owner: bpy.types.ID, path: str) -> Node:
    return type(owner).__name__, owner.name_full, path


def _bone(rig: bpy.types.ID, name: str) -> Node:
    return _key(rig, f"bone {name}")


def _driven(owner: bpy.types.ID, curve: bpy.types.FCurve) -> Node:
    """The property that a driver writes."""
    return _key(owner, f"{curve.data_path}[{curve.array_index}]")


def _read(variable: bpy.types.DriverVariable, target: bpy.types.DriverTarget) -> Node:
    """The property, bone or object that a target of a driver reads."""
    if variable.type == "SINGLE_PROP":
        return _key(target.id, target.data_path if INDEX.search(target.data_path) else f"{target.data_path}[0]")
    return _bone(target.id, target.bone_target) if target.bone_target else _key(target.id, "")
