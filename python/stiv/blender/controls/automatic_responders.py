# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that yield without a role of their own: all that can be moved rigidly."""

from collections.abc import Sequence

import bpy

from stiv import InputError
from stiv.blender.controls.control_set import Participant
from stiv.blender.controls.editable import check_placement, check_unconstrained
from stiv.blender.controls.shared_meshes import other_users
from stiv.blender.controls.transform_locks import is_location_locked
from stiv.blender.scene.dependencies import ancestors, dependencies
from stiv.blender.scene.evaluations import SURFACE_TYPES
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings


def find_automatic_responders(
    objects: Sequence[bpy.types.Object], participants: Sequence[Participant], settings: EditSettings
) -> list[Participant]:
    """Unselected rigid participants for the visible objects of role "auto" that can be moved.

    An object and its children form a family. A family is an obstacle instead if one of its members participates
    already, has another role or a constraint, is animated, linked, locked or of zero size, or if modifiers, constraints
    or instances connect it with other objects. Metaballs are obstacles too, because moving them changes their surface.
    """
    taken = {name for each in participants for name in _moved_with(each)}
    links = _outside_links()
    found: list[Participant] = []
    for ob in sorted(objects, key=lambda each: len(ancestors(each))):
        family = [ob, *ob.children_recursive]
        names = {member.name for member in family}
        above = set(ancestors(ob))
        if (
            ob.type not in SURFACE_TYPES - {"META"}
            or names & taken
            or above & taken
            or not _is_movable_family(family, settings)
        ):
            continue
        if any((user in names) != (used in names) for user, used in links):
            continue
        taken |= names
        found.append(Participant(ObjectReference.of(ob), "rigid", False))
    return found


def _moved_with(participant: Participant) -> list[str]:
    """Names of a participant's object and, if it deforms, of those that share its mesh."""
    ob = participant.reference.find()
    return [ob.name, *(user.name for user in other_users(ob) if participant.role != "rigid")]


def _is_movable_family(family: Sequence[bpy.types.Object], settings: EditSettings) -> bool:
    if any(settings.role(member.name) != "auto" for member in family):
        return False
    try:
        check_placement(family[0])
        if is_location_locked(family[0]):
            return False
        for child in family[1:]:
            check_unconstrained(child)
    except InputError:
        return False
    return True


def _outside_links() -> set[tuple[str, str]]:
    """Pairs of names; the first object depends on the second through anything except its parent."""
    links = {(each.user, each.used) for ob in bpy.data.objects for each in dependencies(ob)}
    for ob in bpy.data.objects:
        if ob.instance_type == "COLLECTION" and ob.instance_collection is not None:
            links |= {(ob.name, other.name) for other in ob.instance_collection.all_objects}
        elif ob.instance_type != "NONE":
            links |= {(ob.name, child.name) for child in ob.children}
    return links
