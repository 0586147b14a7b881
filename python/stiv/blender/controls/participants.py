# SPDX-License-Identifier: GPL-3.0-or-later
"""Who moves, in which way, and who only gives way."""

import bpy

from stiv import InputError
from stiv.blender.controls.automatic_responders import automatic_responders
from stiv.blender.controls.movers import Mover
from stiv.blender.scene.evaluated_scene import SURFACE_TYPES, is_visible
from stiv.blender.scene.evaluations import is_active
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings

EDITABLE_TYPES = ("MESH", "LATTICE")
SOFT = ("laplacian", "arap")


def find_movers(context: bpy.types.Context, settings: EditSettings) -> list[Mover]:
    """All objects with controls, in the order of the view layer, those that nobody gave a role last.

    Raises InputError for a mode that is not supported, unknown names, and when nothing is selected that may move.
    """
    _check_names(context, settings)
    objects = [
        ob for ob in context.view_layer.objects if is_visible(context, ob) and settings.cage_of(ob.name) == ob.name
    ]
    selected = _in_edit_mode(context, objects) if context.mode != "OBJECT" else _selected(objects)
    movers = [mover for ob in objects if (mover := mover_of(ob, ob in selected, settings)) is not None]
    movers = once(movers)
    if settings.responders != "selected" and context.mode == "OBJECT":
        movers += automatic_responders(objects, movers, settings)
    if not any(mover.selected for mover in movers):
        raise InputError("nothing is selected that may move; select a mesh, a lattice or an object with a surface")
    return movers


def _check_names(context: bpy.types.Context, settings: EditSettings) -> None:
    known = set(context.scene.objects.keys())
    for name in settings.named_objects():
        if name not in known:
            raise InputError(f'settings name object "{name}", which the scene does not have')


def _in_edit_mode(context: bpy.types.Context, objects: list[bpy.types.Object]) -> list[bpy.types.Object]:
    if context.mode not in ("EDIT_MESH", "EDIT_LATTICE"):
        mode = context.mode.replace("_", " ").title()
        raise InputError(f"mode {mode} is not supported; go to Object Mode, or Edit Mode of a mesh or lattice")
    return [ob for ob in objects if ob.mode == "EDIT"]


def _selected(objects: list[bpy.types.Object]) -> list[bpy.types.Object]:
    return [ob for ob in objects if ob.select_get()]


def mover_of(ob: bpy.types.Object, selected: bool, settings: EditSettings) -> Mover | None:
    """How an object takes part with controls, by its role and settings; None if without. Raises InputError."""
    role = settings.role(ob.name)
    if role in ("obstacle", "ignored") or (role == "auto" and not selected and not _is_asked(ob, settings)):
        return None
    way = _way(ob, role, settings)
    if way == "rigid":
        return Mover(ObjectReference.of(ob), "rigid", selected) if has_surface(ob) else None
    if way in SOFT:
        return Mover(_handled(ob), "soft", selected)
    if way == "lattice":
        return Mover(_lattice_of(ob), "lattice", selected)
    if ob.type not in EDITABLE_TYPES:
        raise InputError(f'object "{ob.name}": a {ob.type.lower()} has no controls; let it respond rigidly')
    return Mover(ObjectReference.of(ob), "cage" if ob.type == "MESH" else "lattice", selected)


def _is_asked(ob: bpy.types.Object, settings: EditSettings) -> bool:
    """Does an object give way by the deformation that is chosen for it, without being selected?"""
    deforms = settings.deformation(ob.name) not in ("auto", "rigid")
    return deforms and settings.responders != "selected" and ob.mode != "EDIT" and bpy.context.mode == "OBJECT"


def _way(ob: bpy.types.Object, role: str, settings: EditSettings) -> str:
    """By what the object is moved: one of the deformations but "auto"."""
    chosen = settings.deformation(ob.name)
    if ob.mode == "EDIT":
        return chosen if chosen in SOFT and ob.type == "MESH" else "vertices"
    if role == "rigid":
        return "rigid"
    if chosen != "auto":
        return chosen
    deforms = role == "controls" or (settings.object_response == "deform" and ob.type in EDITABLE_TYPES)
    return "vertices" if deforms else "rigid"


def _handled(ob: bpy.types.Object) -> ObjectReference:
    if ob.type != "MESH":
        raise InputError(f'object "{ob.name}": only meshes are moved by handles; choose another deformation for it')
    return ObjectReference.of(ob)


def _lattice_of(ob: bpy.types.Object) -> ObjectReference:
    """The lattice that deforms a mesh; a lattice itself."""
    if ob.type == "LATTICE":
        return ObjectReference.of(ob)
    for modifier in ob.modifiers:
        if isinstance(modifier, bpy.types.LatticeModifier) and modifier.object is not None and is_active(modifier, ob):
            return ObjectReference.of(modifier.object)
    raise InputError(
        f'object "{ob.name}": no lattice deforms it; give it a Lattice modifier, or choose another deformation for it'
    )


def once(movers: list[Mover]) -> list[Mover]:
    """A lattice that comes with several meshes, or is a mover itself, once; selected if any of them is."""
    merged: dict[ObjectReference, Mover] = {}
    for mover in movers:
        known = merged.get(mover.reference)
        merged[mover.reference] = mover if known is None or not known.selected else known
    return list(merged.values())


def has_surface(ob: bpy.types.Object) -> bool:
    """Can the object or what hangs on it have a surface?

    Lattices are kept, to be refused or moved with their mesh; volumes, to be carried along.
    """
    family = [ob, *ob.children_recursive]
    types = SURFACE_TYPES | {"LATTICE", "VOLUME"}
    return any(each.type in types or each.instance_type != "NONE" for each in family)
