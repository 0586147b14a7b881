# SPDX-License-Identifier: GPL-3.0-or-later
"""Groups of objects that move together rigidly: selected objects, their children, and objects tied to them."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace

import bpy

from stiv import InputError
from stiv.blender.controls.control_set import Participant
from stiv.blender.controls.editable import check_placement, check_unconstrained
from stiv.blender.controls.rigid_trial import check_own_transform, moves_as_a_whole
from stiv.blender.controls.transform_locks import can_rotate
from stiv.blender.scene.dependencies import Dependency, add_dependents, ancestors, dependencies
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.followers import can_follow, used_names
from stiv.blender.scene.message_fitting import fit_message


@dataclass(frozen=True)
class RigidGroup:
    """`roots` are written; `members` (names, including the roots) move along.

    bent: names of the members whose modifiers refer to objects that stay. followers: names of meshes that do not belong
    to the group, but whose shape or place depends on its members. tied: names of two objects, the second of which
    depends on the first, or cuts it, so that all can only move as one. note: a message about the objects that cut each
    other; "" if none do.
    """

    roots: tuple[Participant, ...]
    members: frozenset[str]
    bent: frozenset[str] = frozenset()
    followers: frozenset[str] = frozenset()
    tied: tuple[str, str] | None = None
    note: str = ""

    @property
    def surfaces(self) -> frozenset[str]:
        """Names of the objects whose surfaces move."""
        return self.members | self.followers


def find_rigid_groups(participants: list[Participant], evaluations: Collection[str], kind: str) -> list[RigidGroup]:
    """Groups of all rigid participants, in the order of their first roots, with their dependencies in these
    evaluations.

    Raises InputError for objects that cannot be moved, or that yield, or are scaled with a parent, though their shape
    depends on objects that do not move along.
    """
    groups = [
        _family(participant)
        for participant in _topmost([participant for participant in participants if participant.role == "rigid"])
    ]
    for group in list(groups):
        for dependency in _outside_dependencies(group, evaluations):
            groups = _merge_groups(groups, dependency)
    for group in groups:
        for name in sorted(group.members):
            check_own_transform(bpy.data.objects[name], kind if group.roots[0].selected else "move")
    return [_with_bent(group, evaluations, kind) for group in groups]


def _with_bent(group: RigidGroup, evaluations: Collection[str], kind: str) -> RigidGroup:
    """The group with its bent members. Raises InputError for those that Blender cannot evaluate in another place."""
    outside = _outside_dependencies(group, evaluations)
    bent = [each for each in outside if not moves_as_a_whole(bpy.data.objects[each.user])]
    roots = {root.reference.name for root in group.roots}
    for each in bent:
        may_be_sheared = kind == "scale" and each.user not in roots
        if may_be_sheared or not group.roots[0].selected or not _may_bend(each):
            raise InputError(f'{each.user}: {each.through} depends on "{each.used}"; select both')
    return replace(group, bent=frozenset(each.user for each in bent))


def _may_bend(dependency: Dependency) -> bool:
    """Can a copy in another place show the shape that the user has there? Not with constraints or instances."""
    return can_follow(bpy.data.objects[dependency.user]) and not dependency.through.startswith("constraint")


def add_followers(
    groups: Sequence[RigidGroup], shown: Collection[str], deforming: Collection[str], scene: bpy.types.Scene
) -> list[RigidGroup]:
    """Attach the meshes that follow selected groups, and merge groups that have followers in common.

    shown: names of the objects with a surface. deforming: names of those that an edit deforms.
    """
    moving = frozenset().union(*(group.members for group in groups if group.roots[0].selected))
    taken = {name for group in groups for name in group.members}.union(deforming)
    users = used_names(scene)
    found = (add_dependents(set(moving), users) & set(shown)) - taken
    following = {name for name in found if can_follow(bpy.data.objects[name])}
    if not following:
        return list(groups)
    result: list[RigidGroup] = []
    for group in groups:
        followers = add_dependents(set(group.members), users) & following if group.roots[0].selected else set()
        group = replace(group, followers=frozenset(followers))
        tied = [each for each in result if not each.followers.isdisjoint(group.followers)]
        whole = join_groups([*tied, group])
        result = [whole if each in tied[:1] else each for each in result if each not in tied[1:]]
        result += [] if tied else [whole]
    return result


def tie_groups(groups: Sequence[RigidGroup], cutting: Collection[tuple[str, str]], kind: str) -> list[RigidGroup]:
    """Merge selected groups that cut each other.

    cutting: pairs of names of objects that cut each other. Groups with locks, and those that modifiers shape where they
    are, remain alone.
    """
    number = {name: k for k, group in enumerate(groups) if _may_tie(group, kind) for name in group.members}
    clusters = {k: [k] for k in range(len(groups))}
    for first, second in sorted(cutting):
        if first in number and second in number:
            longer, shorter = sorted((clusters[number[first]], clusters[number[second]]), key=len, reverse=True)
            if longer is not shorter:
                longer += shorter
                clusters.update(dict.fromkeys(shorter, longer))
    distinct = sorted(map(sorted, {id(each): each for each in clusters.values()}.values()))
    return [_tie([groups[k] for k in each]) if len(each) > 1 else groups[each[0]] for each in distinct]


def _may_tie(group: RigidGroup, kind: str) -> bool:
    """Can the group take any motion of this kind, without a modifier that shapes it where it is?"""
    if not group.roots[0].selected or group.bent or group.followers:
        return False
    objects = [root.reference.find() for root in group.roots]
    return not any(any(ob.lock_location) or (kind == "rotate" and not can_rotate(ob)) for ob in objects)


def _tie(groups: Sequence[RigidGroup]) -> RigidGroup:
    names = [group.roots[0].reference.name for group in groups]
    if len(names) == 2:
        note = fit_message("{} and {} cut each other, move as one", *names)
    else:
        note = fit_message("{} and {} more cut each other, move as one", names[0], len(names) - 1)
    return replace(join_groups(groups), tied=(names[0], names[1]), note=note)


def check_dependents(
    moved: Collection[str], deforming: Collection[str], names: Iterable[str], evaluations: Collection[str]
) -> None:
    """Refuse to change objects on which other objects depend through modifiers and constraints in these evaluations.

    moved, deforming: names of the objects that move as a whole, and of those whose shape changes. A selection of both
    objects helps only if they move as a whole. Raises InputError.
    """
    for name in names:
        if name in moved or name in deforming:
            continue
        for dependency in dependencies(bpy.data.objects[name], evaluations):
            if dependency.used in deforming:
                raise _deforming_error(name, dependency)
            if dependency.used in moved:
                raise InputError(f'{name}: {dependency.through} depends on "{dependency.used}"; select both')


def _deforming_error(name: str, dependency: Dependency) -> InputError:
    if dependency.renders_only:
        return InputError(f'{name}: {dependency.through} depends on "{dependency.used}"; disable in renders')
    return InputError(f'{name}: {dependency.through} depends on "{dependency.used}"; disable it')


def check_instances(moved: set[str], meshes: Iterable[VisibleMesh], groups: Iterable[RigidGroup] = ()) -> None:
    """Refuse to change objects that others show as instances, except on the faces and vertices of a parent that moves
    along. Raises InputError.
    """
    for mesh in meshes:
        if mesh.is_instance and mesh.source in moved and not _carries(mesh, groups):
            raise InputError(f'{mesh.source}: "{mesh.owner.name}" instances it; make the instances real')


def _carries(mesh: VisibleMesh, groups: Iterable[RigidGroup]) -> bool:
    """Do the instancer and its child move in the same group?"""
    is_child = mesh.owner.find().instance_type in ("FACES", "VERTS")
    return is_child and any({mesh.owner.name, mesh.source} <= group.members for group in groups)


def _topmost(participants: list[Participant]) -> list[Participant]:
    """Participants without a participating ancestor; the others move along with it."""
    names = {each.reference.name: each for each in participants}
    top = []
    for participant in participants:
        above = [names[name] for name in ancestors(participant.reference.find()) if name in names]
        if any(other.selected != participant.selected for other in above):
            raise InputError(
                f'{participant.reference.name}: its parent "{above[0].reference.name}" moves too; select both'
            )
        if not above:
            top.append(participant)
    return top


def _family(participant: Participant) -> RigidGroup:
    root = participant.reference.find()
    check_placement(root, may_be_keyed=participant.selected)
    for child in root.children_recursive:
        check_unconstrained(child)
    return RigidGroup((participant,), frozenset({root.name, *(child.name for child in root.children_recursive)}))


def _outside_dependencies(group: RigidGroup, evaluations: Collection[str]) -> list[Dependency]:
    found = [each for name in sorted(group.members) for each in dependencies(bpy.data.objects[name], evaluations)]
    return [each for each in found if each.used not in group.members]


def _merge_groups(groups: list[RigidGroup], dependency: Dependency) -> list[RigidGroup]:
    """Merge the two groups that a dependency connects."""
    control_seams = [group for group in groups if dependency.user in group.members or dependency.used in group.members]
    if len(control_seams) < 2 or len({root.selected for group in control_seams for root in group.roots}) > 1:
        return groups
    whole = replace(join_groups(control_seams), tied=(dependency.used, dependency.user))
    return [
        whole if group is control_seams[0] else group
        for group in groups
        if group is control_seams[0] or group not in control_seams
    ]


def join_groups(groups: Sequence[RigidGroup]) -> RigidGroup:
    """One group of the objects of several."""
    return RigidGroup(
        tuple(root for group in groups for root in group.roots),
        frozenset().union(*(group.members for group in groups)),
        frozenset().union(*(group.bent for group in groups)),
        frozenset().union(*(group.followers for group in groups)),
        next((group.tied for group in groups if group.tied), None),
        next((group.note for group in groups if group.note), ""),
    )
