# SPDX-License-Identifier: GPL-3.0-or-later
"""Location, rotation and scale as controls of rigid groups."""

from collections.abc import Sequence

import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.object_transform import ObjectTransform, are_parallel, check_axes, read_transform
from stiv.blender.controls.placed_stack import PlacedStack
from stiv.blender.controls.placement_goals import PivotDeformation, PlacementGoal, RotationGoal, ScaleGoal
from stiv.blender.controls.placement_motion import PlacementMotion
from stiv.blender.controls.placement_writer import PlacementWriter
from stiv.blender.controls.rigid_groups import RigidGroup
from stiv.blender.controls.rotations import nearest_rotation
from stiv.blender.controls.transform_locks import can_rotate, find_free_directions
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings


def make_rigid_set(
    group: RigidGroup, surfaces: tuple[int, ...], meshes: Sequence[VisibleMesh], settings: EditSettings, kind: str
) -> ControlSet:
    """Control set of a rigid group, with the meshes of its surfaces; about its origin without any."""
    starts = [read_transform(root.reference.find()) for root in group.roots]
    rest = np.concatenate([each.world() for each in meshes]) if meshes else starts[0].world[None, :3, 3]
    selected = group.roots[0].selected
    scales = kind == "scale" and selected
    frames = _frames(group, starts) if scales else []
    axes = frames[0] if scales else None
    deformation = stiv.rigid(rest) if axes is None else stiv.scaling(rest, axes)
    controls = _rest_controls(rest, axes)
    motion = PlacementMotion(controls[0], controls[0], axes)
    movers = [_movers(each, group) for each in meshes]
    placed = PlacedStack(meshes, movers, controls, motion) if any(movers) else None
    objects = [root.reference.find() for root in group.roots]
    free = None if scales else find_free_directions(objects, starts)
    turns = scales or _may_turn(group, starts, kind if selected else "move", settings)
    turns = turns and free is None  # rotation about the centre would move the origin along locked axes
    can_align = kind == "move" and free is None and _can_turn(group, starts)
    solid = _with_surfaces(group, meshes)
    first = starts[solid[0]] if solid else starts[0]
    tied = group.tied or ((objects[solid[0]].name, objects[solid[1]].name) if len(solid) > 1 else None)
    rule = PlacementGoal(selected, turns, first.world[:3, 3], free, _up(first) if can_align else None, tied)
    about = _about_pivots(rest, meshes, movers)
    if axes is not None:
        rule = ScaleGoal(**vars(rule), axes=axes, about=about, askew=_askew(group, frames))
    elif selected and kind == "rotate":
        rule = RotationGoal(**vars(rule), about=about, free_axis=_turns_on_contact(settings))
    weight = settings.response_weight(True) if selected else 1.0
    max_weights = np.array([1.0, float(turns)]) if free is None else np.array([free.free, np.zeros(3)], np.float64)
    references = tuple(root.reference for root in group.roots)
    return ControlSet(
        tuple(reference.name for reference in references), "rigid", surfaces,
        deformation if placed is None else placed.deformation, controls,
        weight * max_weights, max_weights, None, rule,
        PlacementWriter(references, tuple(starts), motion), note=group.note,
        weight_axes=None if free is None else np.array([free.axes, np.eye(3)]), placed=placed,
    )  # fmt: skip


def _rest_controls(rest: Floats, axes: Floats | None) -> Floats:
    """Centre, and rotation vector or scale factors, (2, 3), at the start. axes: of a scale; None for a rotation."""
    return stiv.rigid_rest_controls(rest) if axes is None else stiv.scaling_rest_controls(rest)


def _movers(mesh: VisibleMesh, group: RigidGroup) -> tuple[ObjectReference, ...]:
    """The objects of the group on whose place the shape of a mesh depends: itself, or the roots; () for rigid ones."""
    if mesh.owner.name in group.followers:
        return tuple(root.reference for root in group.roots)
    return (mesh.owner,) if mesh.owner.name in group.bent else ()


def _with_surfaces(group: RigidGroup, meshes: Sequence[VisibleMesh]) -> list[int]:
    """Numbers of the roots of a group that have a surface, or whose children have one."""
    owners = {mesh.owner.name for mesh in meshes} & group.members
    families = [[root, *root.children_recursive] for root in (each.reference.find() for each in group.roots)]
    return [number for number, family in enumerate(families) if not owners.isdisjoint(ob.name for ob in family)]


def _about_pivots(
    rest: Floats, meshes: Sequence[VisibleMesh], movers: Sequence[tuple[ObjectReference, ...]]
) -> PivotDeformation:
    """Motions about pivots, of the surface `rest`, (n, 3), or of meshes as Blender evaluates them."""

    def make(motion: PlacementMotion) -> tuple[stiv.Deformation, PlacedStack | None]:
        if any(movers):
            stack = PlacedStack(meshes, movers, _rest_controls(rest, motion.axes), motion)
            return stack.deformation, stack
        return stiv.rigid(rest, motion.pivot) if motion.axes is None else stiv.scaling(rest, motion.axes), None

    return PivotDeformation(make)


def _turns_on_contact(settings: EditSettings) -> bool:
    return settings.object_response == "slide_and_turn"


def _may_turn(group: RigidGroup, starts: Sequence[ObjectTransform], kind: str, settings: EditSettings) -> bool:
    """Can all roots be rotated? Not while objects slide, below an unevenly scaled parent, or with locks.

    Raises InputError for rotations below that parent; locked objects move without rotation.
    """
    if kind != "rotate" and not _turns_on_contact(settings):
        return False
    if not all(can_rotate(root.reference.find()) for root in group.roots):
        return False
    for root, start in zip(group.roots, starts, strict=True):
        if not start.can_hold_rotations():
            if kind == "rotate":
                raise InputError(f"{root.reference.name}: its parent is scaled unevenly; apply the parent's scale")
            return False
    return True


def _can_turn(group: RigidGroup, starts: Sequence[ObjectTransform]) -> bool:
    """Can all roots be rotated? Not below an unevenly scaled parent, or with locks."""
    unlocked = all(can_rotate(root.reference.find()) for root in group.roots)
    return unlocked and all(start.can_hold_rotations() for start in starts)


def _up(start: ObjectTransform) -> Floats | None:
    """The unit Z axis of an object; None if its scale is 0."""
    axis = start.world[:3, 2]
    length = float(np.linalg.norm(axis))
    return np.asarray(axis / length) if length > 0 else None


def _frames(group: RigidGroup, starts: Sequence[ObjectTransform]) -> list[Floats]:
    """World axes of the group's roots as rotations, (3, 3). Raises InputError if they are not orthogonal."""
    frames = []
    for root, start in zip(group.roots, starts, strict=True):
        check_axes(root.reference.name, start.world)
        columns = start.world[:3, :3] / np.linalg.norm(start.world[:3, :3], axis=0)
        frames.append(nearest_rotation(columns * [1, 1, np.sign(np.linalg.det(columns))]))
    return frames


def _askew(group: RigidGroup, frames: Sequence[Floats]) -> tuple[str, str] | None:
    """Names of the first root and of one whose axes are not parallel to its axes; None without."""
    names = [root.reference.name for root in group.roots]
    others = (name for name, axes in zip(names, frames, strict=True) if not are_parallel(frames[0], axes))
    return next(((names[0], name) for name in others), None)
