# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that give way without having been given a role: all that can be placed as they are, as rigid wholes."""

from collections.abc import Sequence

import bpy

from stiv import InputError
from stiv.blender.controls.editable import check_placement, check_unconstrained
from stiv.blender.controls.movers import Mover
from stiv.blender.controls.transform_locks import is_locked
from stiv.blender.scene.dependencies import dependencies
from stiv.blender.scene.evaluated_scene import SURFACE_TYPES
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings


def automatic_responders(
    objects: Sequence[bpy.types.Object], movers: Sequence[Mover], settings: EditSettings
) -> list[Mover]:
    """Rigid movers, not selected, for the visible objects of role "auto" that nothing hinders.

    An object hangs together with its children. Left out, and so in the way, is a family of which a member is a mover
    already, has another role or a constraint, is animated, linked, locked or without size, or looks at or is looked at
    by an object outside, through modifiers, constraints or instances. Metaballs are left out too: where they are moved
    to, Blender gives them another surface.
    """
    taken = {mover.reference.name for mover in movers}
    tied = _tied_outside()
    found: list[Mover] = []
    for ob in sorted(objects, key=lambda each: len(_ancestors(each))):
        family = [ob, *ob.children_recursive]
        names = {member.name for member in family}
        above = _ancestors(ob)
        if ob.type not in SURFACE_TYPES - {"META"} or names & taken or above & taken or not _are_free(family, settings):
            continue
        if any((user in names) != (used in names) for user, used in tied):
            continue
        taken |= names
        found.append(Mover(ObjectReference.of(ob), "rigid", False))
    return found


def _are_free(family: Sequence[bpy.types.Object], settings: EditSettings) -> bool:
    if any(settings.role(member.name) != "auto" for member in family):
        return False
    try:
        check_placement(family[0])
        if is_locked(family[0]):
            return False
        for child in family[1:]:
            check_unconstrained(child)
    except InputError:
        return False
    return True


def _ancestors(ob: bpy.types.Object) -> set[str]:
    names = set()
    while ob.parent is not None:
        ob = ob.parent
        names.add(ob.name)
    return names


def _tied_outside() -> set[tuple[str, str]]:
    """Pairs of names of which the first object's shape or place depends on the second, its parent apart."""
    tied = {(each.user, each.used) for ob in bpy.data.objects for each in dependencies(ob)}
    for ob in bpy.data.objects:
        if ob.instance_type == "COLLECTION" and ob.instance_collection is not None:
            tied |= {(ob.name, other.name) for other in ob.instance_collection.all_objects}
        elif ob.instance_type != "NONE":
            tied |= {(ob.name, child.name) for child in ob.children}
    return tied
