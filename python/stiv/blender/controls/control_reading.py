# SPDX-License-Identifier: GPL-3.0-or-later
"""From movers and visible meshes to the parts of an edit."""

from collections.abc import Sequence

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.controls.cage import cage_part
from stiv.blender.controls.control_set import Part
from stiv.blender.controls.handles import soft_parts
from stiv.blender.controls.joined_seams import join_part
from stiv.blender.controls.lattice_modifier import bent_mesh
from stiv.blender.controls.lattice_points import check_lattice, lattice_part
from stiv.blender.controls.movers import Mover
from stiv.blender.controls.rigid_groups import (
    RigidGroup,
    check_instances,
    check_onlookers,
    rigid_groups,
    with_passengers,
)
from stiv.blender.controls.rigid_placement import rigid_part
from stiv.blender.controls.subdivision import stacked
from stiv.blender.controls.transform_locks import without_held
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.evaluations import VIEWPORT, is_active
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings

TOLERANCE = 1e-5  # of the size of an object: what float32 and the mathematics of the modifiers leave


def make_parts(
    context: bpy.types.Context,
    movers: Sequence[Mover],
    meshes: Sequence[VisibleMesh],
    settings: EditSettings,
    kind: str,
) -> tuple[list[Part], list[RigidGroup]]:
    """All parts, and the groups that move as one. Raises InputError for what cannot be moved, nothing changed."""
    movers = without_held(movers, kind)
    groups = rigid_groups(movers, evaluations_of(meshes))
    bent = {mover.reference: _bent_by(mover.reference, meshes) for mover in movers if mover.role == "lattice"}
    _check_independent(movers, groups, bent, meshes)
    groups = with_passengers(groups, {mesh.owner.name for mesh in meshes})
    parts = [_rigid(group, meshes, settings, kind) for group in groups]
    for mover in movers:
        if mover.role == "cage":
            surfaces = _shown_as(mover.reference.name, meshes, settings)
            parts.append(cage_part(mover, surfaces, _read_in(surfaces, meshes), context.scene, settings))
        elif mover.role == "soft":
            surfaces = _shown_as(mover.reference.name, meshes, settings)
            parts += soft_parts(mover, surfaces, _read_in(surfaces, meshes), context.scene, settings)
        elif mover.role == "lattice":
            parts.append(_lattice(context, mover, bent[mover.reference], meshes, settings))
    for part in parts:
        _check_equal(part, meshes)
    return [join_part(part, meshes) for part in parts if part.surfaces], groups


def _rigid(group: RigidGroup, meshes: Sequence[VisibleMesh], settings: EditSettings, kind: str) -> Part:
    surfaces = _shown_by(group.members, meshes)
    rest = np.concatenate([np.empty((0, 3)), *(meshes[index].world() for index in surfaces)])
    return rigid_part(group, surfaces, rest, settings, kind)


def _lattice(
    context: bpy.types.Context,
    mover: Mover,
    surfaces: tuple[int, ...],
    meshes: Sequence[VisibleMesh],
    settings: EditSettings,
) -> Part:
    check_lattice(mover.reference.find())
    if not surfaces:
        raise InputError(f'object "{mover.reference.name}": this lattice deforms no visible mesh')
    bent = [
        bent_mesh(meshes[index].owner.find(), mover.reference, context, meshes[index].read_in) for index in surfaces
    ]
    return lattice_part(mover, surfaces, stacked(bent), settings)


def _shown_by(names: frozenset[str] | set[str], meshes: Sequence[VisibleMesh]) -> tuple[int, ...]:
    return tuple(index for index, mesh in enumerate(meshes) if mesh.owner.name in names)


def _read_in(surfaces: tuple[int, ...], meshes: Sequence[VisibleMesh]) -> list[str]:
    return [meshes[index].read_in for index in surfaces]


def _shown_as(name: str, meshes: Sequence[VisibleMesh], settings: EditSettings) -> tuple[int, ...]:
    """The visible meshes that show a cage."""
    shown = settings.shown_by(name)
    indices = _shown_by({shown}, meshes)
    if not indices and shown != name:
        raise InputError(f'object "{shown}": shows the cage "{name}" and is hidden; show it')
    return indices


def _bent_by(lattice: ObjectReference, meshes: Sequence[VisibleMesh]) -> tuple[int, ...]:
    """The visible meshes that a lattice deforms."""
    found = []
    for index, mesh in enumerate(meshes):
        ob = mesh.owner.find()
        uses = [
            modifier for modifier in ob.modifiers
            if isinstance(modifier, bpy.types.LatticeModifier)
            and modifier.object is not None and modifier.object.session_uid == lattice.session_uid
            and is_active(modifier, ob, mesh.read_in) and modifier.strength != 0
        ]  # fmt: skip
        if not uses:
            continue
        if mesh.is_instance or ob.type != "MESH":
            raise InputError(
                f'object "{ob.name}", modifier "{uses[0].name}": only meshes can follow lattice "{lattice.name}"; '
                "convert the object to a mesh, or hide it"
            )
        if len(uses) > 1:
            raise InputError(
                f'object "{ob.name}", modifier "{uses[1].name}": uses lattice "{lattice.name}" a second time; apply one'
            )
        found.append(index)
    return tuple(found)


def _check_independent(
    movers: Sequence[Mover],
    groups: Sequence[RigidGroup],
    bent: dict[ObjectReference, tuple[int, ...]],
    meshes: Sequence[VisibleMesh],
) -> None:
    """Each object is moved in one way, and changes nothing besides."""
    in_groups = {name for group in groups for name in group.members}
    in_lattices: set[str] = set()
    for lattice, indices in bent.items():
        for name in sorted({meshes[index].owner.name for index in indices}):
            if name in in_lattices:
                raise InputError(f'object "{name}": is deformed by two lattices that move; keep one of them still')
            if name in in_groups or any(m.reference.name == name and m.role in ("cage", "soft") for m in movers):
                raise InputError(
                    f'object "{name}": moves itself and with its lattice "{lattice.name}"; deselect one of the two'
                )
            in_lattices.add(name)
    deformed = {mover.reference.name for mover in movers if mover.role != "rigid"}
    for name in sorted(deformed & in_groups):
        raise InputError(f'object "{name}": is deformed and hangs on an object that moves; deselect one of the two')
    check_onlookers(
        deformed | in_groups, sorted({mesh.owner.name for mesh in meshes} - in_lattices), evaluations_of(meshes)
    )
    check_instances(deformed | in_groups | in_lattices, meshes)
    _check_children(deformed, in_groups, meshes)


def _check_children(deformed: set[str], in_groups: set[str], meshes: Sequence[VisibleMesh]) -> None:
    """Refuse to deform what carries others on its vertices, as children or as instances."""
    for mesh in meshes:
        ob = mesh.owner.find()
        if ob.name in deformed and mesh.is_instance:
            raise InputError(f'object "{ob.name}": shows instances that would move with its vertices; make them real')
        if ob.parent is not None and ob.parent.name in deformed and ob.parent_type.startswith(("VERTEX", "LATTICE")):
            raise InputError(f'object "{ob.name}": hangs on vertices of object "{ob.parent.name}"; clear the parent')


def _check_equal(part: Part, meshes: Sequence[VisibleMesh]) -> None:
    """Compare f(p) with what Blender shows, mesh by mesh."""
    computed: Floats = part.deformation.surface(part.controls)
    shown = [meshes[index].world() for index in part.surfaces]
    counts = [len(each) for each in shown]
    if sum(counts) != len(computed):
        _disagree(part, meshes[part.surfaces[0]] if part.surfaces else None, f"{len(computed)} vertices are expected")
    for index, mine, theirs in zip(part.surfaces, np.split(computed, np.cumsum(counts)[:-1]), shown, strict=True):
        difference = float(np.abs(mine - theirs).max(initial=0.0))
        if difference > tolerance(theirs):
            _disagree(part, meshes[index], f"differs by {difference:.3g}")


def evaluations_of(meshes: Sequence[VisibleMesh]) -> frozenset[str]:
    """All evaluations that show any of the meshes; Object Mode is always among them."""
    return frozenset({VIEWPORT}).union(*(mesh.exists_in for mesh in meshes))


def tolerance(points: Floats) -> float:
    """By how much two evaluations of the same points, (n, 3), may differ, in world units."""
    if len(points) == 0:
        return 0.0
    return TOLERANCE * float(np.ptp(points, axis=0).max()) + 1e-6 * float(np.abs(points).max())


def _disagree(part: Part, mesh: VisibleMesh | None, how: str) -> None:
    name = part.names[0] if mesh is None else mesh.owner.name
    stack = ", ".join(f'"{modifier.name}"' for modifier in bpy.data.objects[name].modifiers) or "none"
    raise InputError(
        f'object "{name}", modifiers {stack}: what Blender shows is not what STIV computes ({how}); apply the '
        "modifiers, let the object respond rigidly, or make it an obstacle"
    )
