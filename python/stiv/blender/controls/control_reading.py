# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the control sets of an edit from its participants and the visible meshes."""

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import replace

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.controls.bone_set import make_bone_set
from stiv.blender.controls.cage import make_cage_set_steps
from stiv.blender.controls.control_set import ControlSet, Participant, ShownAs
from stiv.blender.controls.curve_points import make_curve_set
from stiv.blender.controls.editable import shared_data_error
from stiv.blender.controls.garments import make_garments
from stiv.blender.controls.handles import make_handle_sets
from stiv.blender.controls.joined_seams import join_seams
from stiv.blender.controls.lattice_modifier import lattice_deformation
from stiv.blender.controls.lattice_points import check_lattice, make_lattice_set
from stiv.blender.controls.passengers import attach_passengers, leave_held_passengers, make_passenger_set
from stiv.blender.controls.rigid_groups import (
    RigidGroup,
    add_followers,
    check_dependents,
    check_instances,
    find_rigid_groups,
    tie_groups,
)
from stiv.blender.controls.rigid_placement import make_rigid_set
from stiv.blender.controls.shared_meshes import other_users
from stiv.blender.controls.stack_refusals import no_surface_error
from stiv.blender.controls.subdivision import stack_deformations
from stiv.blender.controls.transform_locks import drop_locked
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.dependencies import dependencies
from stiv.blender.scene.evaluated_scene import VisibleMesh, evaluation_tolerance
from stiv.blender.scene.evaluations import VIEWPORT, is_active
from stiv.blender.scene.modifier_stack import UnsupportedStackError, modifier_error, simulation_error
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings
from stiv.task import Steps, Turns, run


def make_control_sets(
    context: bpy.types.Context,
    participants: Sequence[Participant],
    meshes: Sequence[VisibleMesh],
    settings: EditSettings,
    kind: str,
) -> tuple[list[ControlSet], list[RigidGroup]]:
    """Make all control sets and rigid groups. Raises InputError for what cannot be moved, with nothing changed."""
    return run(make_control_sets_steps(context, participants, meshes, settings, kind))


def make_control_sets_steps(
    context: bpy.types.Context,
    participants: Sequence[Participant],
    meshes: Sequence[VisibleMesh],
    settings: EditSettings,
    kind: str,
    cutting: Collection[tuple[str, str]] = (),
) -> Steps[tuple[list[ControlSet], list[RigidGroup]]]:
    """Steps of `make_control_sets`. cutting: pairs of names of selected objects that cut each other, and move as one
    unless each uses its own pivot.
    """
    turns = Turns()
    if any(each.role == "bones" for each in participants):
        return [_posed(context, participants, meshes, settings, kind)], []
    participants, note = leave_held_passengers(context, participants, kind)
    participants = drop_locked(participants, kind)
    groups = find_rigid_groups(participants, evaluations_of(meshes), kind)
    by_lattice = {
        participant.reference: _deformed_by(participant.reference, meshes)
        for participant in participants
        if participant.role == "lattice"
    }
    deforming = {name for each in participants if each.role != "rigid" for name in _deformed_with(each)}
    deformed = deforming.union(meshes[index].owner.name for indices in by_lattice.values() for index in indices)
    groups = add_followers(groups, {mesh.owner.name for mesh in meshes}, deformed, context.scene)
    _check_independent(participants, groups, by_lattice, meshes, deforming)
    if kind == "move" or context.scene.tool_settings.transform_pivot_point != "INDIVIDUAL_ORIGINS":
        groups = tie_groups(groups, cutting, kind)
    groups, passengers = attach_passengers(groups, {mesh.owner.name for mesh in meshes})
    control_sets = [_rigid(group, meshes, settings, kind) for group in groups]
    for participant in participants:
        yield from turns.take()
        if participant.role == "lattice":
            control_sets.append(_lattice(context, participant, by_lattice[participant.reference], meshes, settings))
        elif participant.role != "rigid":
            control_sets += yield from _deformed_steps(context, participant, meshes, settings)
    for control_set in control_sets:
        _check_surface(control_set, meshes)
        _check_references(control_set, {name for each in control_sets for name in each.names})
    found = [join_seams(each, meshes) for each in control_sets if each.surfaces]
    if any(each.rule.moves for each in found):
        found += [make_passenger_set(group, settings, kind) for group in passengers]
    noted = [replace(each, passenger_note=note) for each in found[:1]]
    return [*noted, *found[1:]], groups


def _posed(
    context: bpy.types.Context,
    participants: Sequence[Participant],
    meshes: Sequence[VisibleMesh],
    settings: EditSettings,
    kind: str,
) -> ControlSet:
    rigs = [each for each in participants if each.role == "bones"]
    clothes = [each for each in participants if each.role != "bones"]
    garments = make_garments(context, clothes, meshes, settings)
    posed = make_bone_set(context, rigs, meshes, settings, kind, garments)
    assert posed.posed is not None
    _check_surface(posed, posed.posed.meshes)
    return posed


def _deformed_steps(
    context: bpy.types.Context, participant: Participant, meshes: Sequence[VisibleMesh], settings: EditSettings
) -> Steps[list[ControlSet]]:
    """Steps that make the control sets of a mesh or curve whose own points are the controls, or its handles."""
    surfaces = _shown_as(participant.reference.name, meshes, settings)
    shown = _read_in(surfaces, meshes)
    if participant.role == "curve":
        evaluations = [each.evaluation for each in shown]
        return [make_curve_set(participant, surfaces, evaluations, context.scene, settings)]
    if participant.role == "soft":
        return make_handle_sets(participant, surfaces, shown, context.scene, settings)
    return [(yield from make_cage_set_steps(participant, surfaces, shown, context.scene, settings))]


def _rigid(group: RigidGroup, meshes: Sequence[VisibleMesh], settings: EditSettings, kind: str) -> ControlSet:
    surfaces = _shown_by(group.surfaces, meshes)
    return make_rigid_set(group, surfaces, [meshes[index] for index in surfaces], settings, kind)


def _lattice(
    context: bpy.types.Context,
    participant: Participant,
    surfaces: tuple[int, ...],
    meshes: Sequence[VisibleMesh],
    settings: EditSettings,
) -> ControlSet:
    check_lattice(participant.reference.find())
    if not surfaces:
        raise InputError(f"{participant.reference.name}: the lattice deforms no visible mesh; show one")
    deformations = [
        lattice_deformation(meshes[index].owner.find(), participant.reference, context, meshes[index].read_from)
        for index in surfaces
    ]
    return make_lattice_set(participant, surfaces, stack_deformations(deformations), settings)


def _shown_by(names: frozenset[str] | set[str], meshes: Sequence[VisibleMesh]) -> tuple[int, ...]:
    return tuple(index for index, mesh in enumerate(meshes) if mesh.owner.name in names)


def _read_in(surfaces: tuple[int, ...], meshes: Sequence[VisibleMesh]) -> list[ShownAs]:
    return [ShownAs(meshes[index].owner.name, meshes[index].read_from) for index in surfaces]


def _shown_as(name: str, meshes: Sequence[VisibleMesh], settings: EditSettings) -> tuple[int, ...]:
    """Indices of the visible meshes that show a cage, those of objects that share its mesh last."""
    shown = settings.shown_by(name)
    ob = bpy.data.objects[name]
    users = {user.name for user in other_users(ob)}
    if users and (users | {name}) & set(settings.loops):
        raise shared_data_error(ob, bpy.data.objects[min(users)])
    indices = _shown_by({shown}, meshes) + _shown_by(users, meshes)
    if not indices and shown != name:
        raise InputError(f'{shown}: shows the cage "{name}" and is hidden; show it')
    if not any(len(meshes[index].local) for index in indices):
        raise no_surface_error(bpy.data.objects[name])
    return indices


def _deformed_by(lattice: ObjectReference, meshes: Sequence[VisibleMesh]) -> tuple[int, ...]:
    """Indices of the visible meshes that a lattice deforms."""
    found = []
    for index, mesh in enumerate(meshes):
        ob = mesh.owner.find()
        uses = [
            modifier for modifier in ob.modifiers
            if isinstance(modifier, bpy.types.LatticeModifier)
            and modifier.object is not None and modifier.object.session_uid == lattice.session_uid
            and is_active(modifier, ob, mesh.read_from) and modifier.strength != 0
        ]  # fmt: skip
        if not uses:
            continue
        if mesh.is_instance or ob.type != "MESH":
            raise InputError(f'{ob.name}: only meshes follow lattice "{lattice.name}"; convert it to a mesh')
        if len(uses) > 1:
            raise modifier_error(ob, uses[1].name, "same lattice", lattice.name)
        found.append(index)
    return tuple(found)


def _check_independent(
    participants: Sequence[Participant],
    groups: Sequence[RigidGroup],
    by_lattice: dict[ObjectReference, tuple[int, ...]],
    meshes: Sequence[VisibleMesh],
    deforming: set[str],
) -> None:
    """Refuse objects that would move in two ways, or change other objects."""
    in_groups = {name for group in groups for name in group.members}
    following = {name for group in groups for name in group.followers}
    in_lattices: set[str] = set()
    for lattice, indices in by_lattice.items():
        for name in sorted({meshes[index].owner.name for index in indices}):
            if name in in_lattices:
                raise InputError(f"{name}: two moving lattices deform it; deselect one")
            if name in in_groups or any(m.reference.name == name and m.role in ("cage", "soft") for m in participants):
                raise InputError(f'{name}: moves, and so does its lattice "{lattice.name}"; deselect one')
            in_lattices.add(name)
    for name in sorted(deforming & in_groups):
        raise InputError(f"{name}: is deformed, and its parent moves; deselect one")
    others = sorted({mesh.owner.name for mesh in meshes} - in_lattices - following)
    check_dependents(in_groups, deforming, others, evaluations_of(meshes))
    check_instances(deforming | in_groups | in_lattices | following, meshes, groups)
    _check_children(deforming, in_groups, meshes)


def _deformed_with(participant: Participant) -> list[str]:
    """Names of a deforming object and of those that share its mesh."""
    ob = participant.reference.find()
    return [ob.name, *(user.name for user in other_users(ob))]


def _check_children(deformed: set[str], in_groups: set[str], meshes: Sequence[VisibleMesh]) -> None:
    """Refuse to deform objects that carry others on their vertices, as children or as instances."""
    for mesh in meshes:
        ob = mesh.owner.find()
        if ob.name in deformed and mesh.is_instance:
            raise InputError(f"{ob.name}: its vertices carry instances; make them real")
        if ob.parent is not None and ob.parent.name in deformed and ob.parent_type.startswith(("VERTEX", "LATTICE")):
            raise InputError(f'{ob.name}: is parented to vertices of "{ob.parent.name}"; clear the parent')
    shown = Counter((mesh.owner.name, mesh.read_from) for mesh in meshes)
    for (name, _), count in shown.items():
        if name in deformed and count > 1:
            ob = bpy.data.objects[name]
            nodes = [each.name for each in ob.modifiers if each.type == "NODES"]
            raise modifier_error(ob, nodes[0], "shows instances")


def _check_surface(control_set: ControlSet, meshes: Sequence[VisibleMesh]) -> None:
    """Refuse a control set whose surface differs from Blender's evaluation."""
    computed: Floats = control_set.deformation.surface(control_set.controls)
    seams = control_set.seams or (None,) * len(control_set.surfaces)
    worlds = [meshes[index].world() for index in control_set.surfaces]
    shown = [world if each is None else world[each.first] for world, each in zip(worlds, seams, strict=True)]
    counts = [len(each) for each in shown]
    if sum(counts) != len(computed):
        _refuse_difference(
            control_set,
            meshes[control_set.surfaces[0]] if control_set.surfaces else None,
            "vertex count",
        )
    for index, mine, theirs in zip(
        control_set.surfaces, np.split(computed, np.cumsum(counts)[:-1]), shown, strict=True
    ):
        difference = float(np.abs(mine - theirs).max(initial=0.0))
        if difference > evaluation_tolerance(theirs):
            _refuse_difference(control_set, meshes[index], f"by {difference:.3g}")


def evaluations_of(meshes: Sequence[VisibleMesh]) -> frozenset[str]:
    """All evaluations that show any of the meshes, and Object Mode."""
    return frozenset({VIEWPORT}).union(*(mesh.shown_in for mesh in meshes))


def _check_references(control_set: ControlSet, moving: set[str]) -> None:
    """Refuse modifiers that are evaluated during the edit and refer to other objects that move."""
    for name in control_set.names if control_set.observed is not None or control_set.role == "curve" else ():
        for dependency in dependencies(bpy.data.objects[name]):
            if dependency.used in moving:
                raise InputError(f'{name}: {dependency.through} uses "{dependency.used}"; deselect one')


def _refuse_difference(control_set: ControlSet, mesh: VisibleMesh | None, how: str) -> None:
    name = control_set.names[0] if mesh is None else mesh.owner.name
    ob = bpy.data.objects[name]
    if control_set.posed is not None:  # to apply its Armature modifier would end the posing
        raise InputError(f"{name}: its pose cannot be followed ({how}); check bone constraints")
    if error := simulation_error(ob, VIEWPORT):
        raise error
    last = next((each.name for each in reversed(ob.modifiers) if is_active(each, ob, VIEWPORT)), "")
    raise UnsupportedStackError(f"{name}: its modifiers cannot be followed ({how}); apply them", name, last)
