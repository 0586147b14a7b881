# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the participants of an edit: objects with controls that move or yield."""

from collections.abc import Sequence

import bpy

from stiv import InputError
from stiv.blender.controls.automatic_responders import find_automatic_responders
from stiv.blender.controls.bone_set import find_posed_rigs
from stiv.blender.controls.control_set import Participant
from stiv.blender.scene.evaluations import SURFACE_TYPES, is_active, is_visible
from stiv.blender.scene.followers import can_follow, reached
from stiv.blender.scene.message_fitting import first_and_others, fit_message
from stiv.blender.scene.references import ObjectReference, type_name
from stiv.blender.settings import EditSettings

EDITABLE_TYPES = {"MESH": "cage", "LATTICE": "lattice", "CURVE": "curve", "SURFACE": "curve"}  # and their roles
EDIT_MODES = ("EDIT_MESH", "EDIT_LATTICE", "EDIT_CURVE", "EDIT_SURFACE")
SOFT = ("laplacian", "arap")


def find_participants(context: bpy.types.Context, settings: EditSettings) -> list[Participant]:
    """All objects with controls in the order of the view layer, followed by those that yield automatically.

    Raises InputError for unsupported modes and unknown names, and if nothing movable is selected.
    """
    _check_names(context, settings)
    if context.mode == "POSE":
        return [*find_posed_rigs(context), *find_clothes(context, settings)]
    objects = [
        ob for ob in context.view_layer.objects if is_visible(context, ob) and settings.cage_of(ob.name) == ob.name
    ]
    selected = (
        _in_edit_mode(context, objects) if context.mode != "OBJECT" else [ob for ob in objects if ob.select_get()]
    )
    if context.mode == "EDIT_MESH" and not any(ob.data.total_vert_sel for ob in selected):
        raise nothing_selected()  # before modifiers are read, which can take long
    participants = [
        participant for ob in objects if (participant := make_participant(ob, ob in selected, settings)) is not None
    ]
    participants = merge_participants(participants)
    if settings.responders != "selected" and context.mode == "OBJECT":
        participants += find_automatic_responders(objects, participants, settings)
    movable = [each.reference.find() for each in participants if each.selected]
    if not movable or (context.mode == "OBJECT" and not moves_surface(context, movable)):
        raise nothing_movable([ob.name for ob in selected if settings.participates(settings.shown_by(ob.name))])
    return participants


def find_clothes(context: bpy.types.Context, settings: EditSettings) -> list[Participant]:
    """The visible meshes and lattices that yield to bones, by their role or their own deformation."""
    rigs = set(context.objects_in_mode)
    objects = [ob for ob in context.view_layer.objects if ob not in rigs and is_visible(context, ob)]
    found = [each for ob in objects if (each := make_participant(ob, False, settings)) is not None]
    return merge_participants([each for each in found if each.role != "rigid"])


def nothing_selected() -> InputError:
    """The error for a selection without vertices or points that can move."""
    return InputError("nothing movable is selected; select vertices, points or objects with a surface")


def nothing_movable(names: Sequence[str]) -> InputError:
    """The error for a selection that cannot move, from the names of selected objects without a surface."""
    if not names:
        return InputError("nothing movable is selected; select an object with a surface")
    return InputError(fit_message("{}{}: no surface; also select an object that has one", *first_and_others(names)))


def _check_names(context: bpy.types.Context, settings: EditSettings) -> None:
    known = set(context.scene.objects.keys())
    for name in settings.named_objects():
        if name not in known:
            raise InputError(f"{name}: the settings name it, but the scene does not have it")


def _in_edit_mode(context: bpy.types.Context, objects: list[bpy.types.Object]) -> list[bpy.types.Object]:
    if context.mode == "EDIT_TEXT":
        raise InputError(f"{context.edit_object.name}: text has no points; use Object Mode")
    if context.mode not in EDIT_MODES:
        mode = context.mode.replace("_", " ").title()
        raise InputError(f"mode {mode} is not supported; use Object Mode")
    return [ob for ob in objects if ob.mode == "EDIT"]


def make_participant(ob: bpy.types.Object, selected: bool, settings: EditSettings) -> Participant | None:
    """The participant for an object, by its role and settings; None for an obstacle. Raises InputError."""
    role = settings.role(ob.name)
    if role in ("obstacle", "ignored") or (
        role == "auto" and not selected and not _yields_by_deformation(ob, settings)
    ):
        return None
    deformation = _deformation_of(ob, role, settings)
    if deformation == "rigid":
        return Participant(ObjectReference.of(ob), "rigid", selected) if selected or may_have_surface(ob) else None
    if deformation in SOFT:
        return Participant(_mesh_reference(ob), "soft", selected)
    if deformation == "lattice":
        return Participant(_lattice_of(ob), "lattice", selected)
    if ob.type not in EDITABLE_TYPES:
        raise InputError(f"{ob.name}: a {type_name(ob)} has no controls; set its deformation to Rigid")
    return Participant(ObjectReference.of(ob), EDITABLE_TYPES[ob.type], selected)


def _yields_by_deformation(ob: bpy.types.Object, settings: EditSettings) -> bool:
    """Does an unselected object yield because of its own deformation?"""
    deforms = settings.deformation(ob.name) not in ("auto", "rigid")
    return (
        deforms and settings.responders != "selected" and bpy.context.mode in ("OBJECT", "POSE") and ob.mode == "OBJECT"
    )


def _deformation_of(ob: bpy.types.Object, role: str, settings: EditSettings) -> str:
    """How the object deforms: any of the deformations except "auto"."""
    chosen = settings.deformation(ob.name)
    if ob.mode == "EDIT":
        return chosen if chosen in SOFT and ob.type == "MESH" else "vertices"
    if role == "rigid":
        return "rigid"
    if chosen != "auto":
        return chosen
    deforms = role == "controls" or (settings.object_response == "deform" and ob.type in EDITABLE_TYPES)
    return "vertices" if deforms else "rigid"


def _mesh_reference(ob: bpy.types.Object) -> ObjectReference:
    if ob.type != "MESH":
        raise InputError(f"{ob.name}: only meshes have handles; choose another deformation")
    return ObjectReference.of(ob)


def _lattice_of(ob: bpy.types.Object) -> ObjectReference:
    """The lattice that deforms a mesh; a lattice itself."""
    if ob.type == "LATTICE":
        return ObjectReference.of(ob)
    for modifier in ob.modifiers:
        if isinstance(modifier, bpy.types.LatticeModifier) and modifier.object is not None and is_active(modifier, ob):
            return ObjectReference.of(modifier.object)
    raise InputError(f"{ob.name}: no lattice deforms it; add a Lattice modifier")


def merge_participants(participants: list[Participant]) -> list[Participant]:
    """Merge participants of the same object, such as the lattice of several meshes, and those that deform the same
    mesh; selected if any of them is.
    """
    merged: dict[object, Participant] = {}
    for participant in participants:
        key = participant.reference if participant.role == "rigid" else participant.reference.find().data
        known = merged.get(key)
        merged[key] = participant if known is None or not known.selected else known
    return list(merged.values())


def moves_surface(context: bpy.types.Context, objects: Sequence[bpy.types.Object]) -> bool:
    """Have any of the objects or their children a surface, or does a visible one follow them?"""
    return any(map(may_have_surface, objects)) or not followed_objects(context).isdisjoint(objects)


def followed_objects(context: bpy.types.Context) -> set[bpy.types.Object]:
    """The objects on which the shape or the place of a visible mesh depends, and these meshes."""
    return set(reached([ob for ob in context.scene.objects if can_follow(ob) and is_visible(context, ob)])[0].values())


def may_have_surface(ob: bpy.types.Object) -> bool:
    """Can the object or its children have a surface?

    Lattices count because they move with their mesh or are refused, volumes because they move along.
    """
    family = [ob, *ob.children_recursive]
    types = SURFACE_TYPES | {"LATTICE", "VOLUME"}
    return any(each.type in types or each.instance_type != "NONE" for each in family)
