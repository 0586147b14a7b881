# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that move as one: a selected object, all that hangs on it, and what their modifiers tie together."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass

import bpy

from stiv import InputError
from stiv.blender.controls.editable import check_placement, check_unconstrained
from stiv.blender.controls.movers import Mover
from stiv.blender.scene.dependencies import Dependency, dependencies
from stiv.blender.scene.evaluated_scene import VisibleMesh


@dataclass(frozen=True)
class RigidGroup:
    """`roots` are written, `members` (names, roots included) move along."""

    roots: tuple[Mover, ...]
    members: frozenset[str]


def rigid_groups(movers: list[Mover], evaluations: Collection[str]) -> list[RigidGroup]:
    """The groups of all rigid movers, in the order of their first roots, as tied together in these evaluations.

    Raises InputError for objects that cannot be placed, or whose shape depends on what does not move along.
    """
    groups = [_family(mover) for mover in _topmost([mover for mover in movers if mover.role == "rigid"])]
    for group in list(groups):
        for dependency in _looking_out(group, evaluations):
            groups = _joined(groups, dependency)
    for group in groups:
        for dependency in _looking_out(group, evaluations):
            raise InputError(
                f'object "{dependency.user}", {dependency.through}: looks at object "{dependency.used}", which does '
                "not move along; select that as well, apply the modifier, or deform the object instead"
            )
    return groups


def with_passengers(groups: list[RigidGroup], shown: Collection[str]) -> list[RigidGroup]:
    """The groups with a surface; the first selected one takes selected groups without surface along.

    shown: names of the objects with a surface. A group without surface meets nothing and cannot be solved for.
    """
    solid = [group for group in groups if not group.members.isdisjoint(shown)]
    first = next((group for group in solid if group.roots[0].selected), None)
    if first is None:
        return solid
    passengers = [group for group in groups if group not in solid and group.roots[0].selected]
    whole = RigidGroup(
        tuple(root for group in (first, *passengers) for root in group.roots),
        frozenset().union(*(group.members for group in (first, *passengers))),
    )
    return [whole if group is first else group for group in solid]


def check_onlookers(moved: Iterable[str], names: Iterable[str], evaluations: Collection[str]) -> None:
    """Refuse to change objects that others, by name, look at through modifiers and constraints in these evaluations.

    Raises InputError.
    """
    changing = set(moved)
    for name in names:
        if name in changing:
            continue
        for dependency in dependencies(bpy.data.objects[name], evaluations):
            if dependency.used in changing:
                raise InputError(
                    f'object "{name}", {dependency.through}: would change with object "{dependency.used}"; select '
                    "it as well, or apply or disable that"
                )


def check_instances(moved: set[str], meshes: Iterable[VisibleMesh]) -> None:
    """Refuse to change objects that other objects show as instances. Raises InputError."""
    for mesh in meshes:
        if mesh.is_instance and mesh.source in moved:
            raise InputError(
                f'object "{mesh.source}": is also shown by the instances of object "{mesh.owner.name}", which would '
                "change too; make the instances real, hide them, or make the object an obstacle"
            )


def _topmost(movers: list[Mover]) -> list[Mover]:
    """Movers that do not hang on another one; those that do move along with it."""
    names = {mover.reference.name: mover for mover in movers}
    top = []
    for mover in movers:
        above = [names[name] for name in _ancestors(mover.reference.find()) if name in names]
        if any(other.selected != mover.selected for other in above):
            raise InputError(
                f'object "{mover.reference.name}": hangs on object "{above[0].reference.name}", which moves too; '
                "give one of them the role of an obstacle, or select both"
            )
        if not above:
            top.append(mover)
    return top


def _ancestors(ob: bpy.types.Object) -> list[str]:
    names = []
    while ob.parent is not None:
        ob = ob.parent
        names.append(ob.name)
    return names


def _family(mover: Mover) -> RigidGroup:
    root = mover.reference.find()
    check_placement(root)
    for child in root.children_recursive:
        check_unconstrained(child)
    return RigidGroup((mover,), frozenset({root.name, *(child.name for child in root.children_recursive)}))


def _looking_out(group: RigidGroup, evaluations: Collection[str]) -> list[Dependency]:
    found = [each for name in sorted(group.members) for each in dependencies(bpy.data.objects[name], evaluations)]
    return [each for each in found if each.used not in group.members]


def _joined(groups: list[RigidGroup], dependency: Dependency) -> list[RigidGroup]:
    """Groups with the two that a dependency ties together made one."""
    tied = [group for group in groups if dependency.user in group.members or dependency.used in group.members]
    if len(tied) < 2 or len({root.selected for group in tied for root in group.roots}) > 1:
        return groups
    whole = RigidGroup(
        tuple(root for group in tied for root in group.roots), frozenset().union(*(group.members for group in tied))
    )
    return [whole if group is tied[0] else group for group in groups if group is tied[0] or group not in tied]
