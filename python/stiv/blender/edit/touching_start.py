# SPDX-License-Identifier: GPL-3.0-or-later
"""Starts an edit of objects in contact with others, such as a crate on the floor: those that touch are parted first, by
rounding. Where they cannot be, and in Edit Mode, they may touch.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import pairwise

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.directions import ALL_FREE, FreeDirections
from stiv.blender.controls.editable import is_keyed
from stiv.blender.controls.placement_goals import PlacementGoal
from stiv.blender.controls.placement_writer import PlacementWriter
from stiv.blender.edit.late_seams import start_steps
from stiv.blender.edit.sessions import ObjectsIntersectError, restore_controls
from stiv.blender.edit.snapshot import EditSnapshot, find_moving_vertices
from stiv.blender.edit.solver import EditSolver, start_solver_steps
from stiv.blender.scene.arrays import Flags, Floats, Indices, extents, transform_points
from stiv.blender.scene.assembly import Assembly, assemble_against_others
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.exclusions import pairs_of_objects
from stiv.blender.scene.references import SceneChangedError
from stiv.task import Steps
from stiv.touching import DEEPEST, DEEPEST_LEFT, are_touching, find_parting, rounding_of

GAP = 8  # between parted objects, in roundings of the moving objects
SURPLUS = 1 + 2.0**-20  # of coordinates: a session computes them again, which may round to a larger power of two
NEAR = 4  # gaps within which objects are in contact
KEPT = 0.5  # of the gap: the minimum distance where objects are in contact, the least that single precision can keep
TOUCHING = 0.4  # of the gap: less than edits keep; so near are only objects that touched before rounding
MOST_NEAR = 8  # pairs of objects in contact that are sought

Started = tuple[EditSnapshot, EditSolver]
PartedStart = tuple[EditSnapshot, EditSolver, "Parting | None"]
Pairs = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Parting:
    """Objects that a start has parted from those that they touched.

    Attributes:
        control_sets: of these objects; their start is the one before.
    """

    control_sets: tuple[ControlSet, ...]

    def restore(self) -> None:
        """Restore the objects exactly. Raises SceneChangedError if one was removed."""
        restore_controls(self.control_sets)


def start_clear_steps(
    read: Callable[[], Steps[EditSnapshot]],
) -> Steps[PartedStart]:
    """Steps that read the scene and start a solver. They refuse objects that touch others."""
    return *(yield from start_steps(read())), None


def start_apart_steps(
    read: Callable[[], Steps[EditSnapshot]],
) -> Steps[PartedStart]:
    """Steps that read the scene and start a solver, after parting moving objects that only touch others.

    read: makes steps that read the scene. Raise InputError and StartIntersectsError, with nothing changed.
    """
    snapshot = yield from read()
    if _deforms_all(snapshot):
        return *(yield from _start_in_contact_steps(replace(snapshot, may_touch=True))), None
    movers, refusal = _Movers.of(snapshot), None
    try:
        clear = snapshot, (yield from start_solver_steps(snapshot))
    except ObjectsIntersectError as error:
        if movers is None or not _only_touch(error, movers.names, movers.deepest):
            raise
        parting, refusal = (yield from _part_steps(error.assembly, movers)), error
    else:
        contacts = yield from _contacts_steps(*clear, movers)
        if movers is None or not contacts:
            return *clear, None
        parting = None
        if contacts[0].distance < TOUCHING * movers.gap:
            parting = yield from _part_steps(snapshot.assembly, movers, [each.triangles for each in contacts])
        if parting is None:
            kept = movers.with_small_distance(snapshot)
            return kept, (yield from start_solver_steps(kept)), None
    if parting is not None:
        try:
            return *(yield from _start_parted_steps(read, parting)), parting
        except ObjectsIntersectError:
            if refusal is None:
                return *clear, None
    assert refusal is not None
    try:
        return *(yield from _start_in_contact_steps(replace(snapshot, may_touch=True))), None
    except ObjectsIntersectError:
        raise refusal from None


def _deforms_all(snapshot: EditSnapshot) -> bool:
    """Does the edit deform all that it moves, so that nothing can be parted?"""
    moving = [each for each in snapshot.control_sets if each.rule.moves]
    return all(each.role != "rigid" or each.placed is not None for each in moving)


def _start_in_contact_steps(snapshot: EditSnapshot) -> Steps[Started]:
    """Steps that start where objects may touch others; if they do, with a minimum distance that they already have.

    They keep the automatic one from themselves: a part thinner than rounding would have no side.
    """
    solver = yield from start_solver_steps(snapshot)
    settings, touching = snapshot.settings, solver.touching_others
    if not touching or settings.separation > 0:
        return snapshot, solver
    moving = {index for each in snapshot.control_sets if each.rule.moves for index in each.surfaces}
    meshes = [snapshot.assembly.meshes[index] for index in sorted(moving)]
    least = KEPT * GAP * max(rounding_of(SURPLUS * points) for mesh in meshes for points in (mesh.world(), mesh.local))
    chosen = {frozenset(pair[:2]) for pair in settings.pair_separations}
    pairs = tuple((*names, least) for names in touching if frozenset(names) not in chosen)
    kept = replace(snapshot, settings=replace(settings, pair_separations=(*settings.pair_separations, *pairs)))
    try:
        return kept, (yield from start_solver_steps(kept))
    except InputError:  # a stretched frame keeps larger distances only
        return snapshot, solver


def _start_parted_steps(read: Callable[[], Steps[EditSnapshot]], parting: Parting) -> Steps[Started]:
    """Steps that start from the parted objects; if they do not succeed, or a caller ends them, they restore these."""
    try:
        snapshot = yield from read()
        movers = _Movers.of(snapshot)
        kept = snapshot if movers is None else movers.with_small_distance(snapshot)
        return kept, (yield from start_solver_steps(kept))
    except BaseException:
        with suppress(SceneChangedError):
            parting.restore()
        raise


def _part_steps(assembly: Assembly, movers: _Movers, near: Sequence[tuple[int, int]] = ()) -> Steps[Parting | None]:
    """Steps that part the moving objects from those that they touch; None, with nothing changed, if they cannot.

    near: pairs of triangles that would touch, were it not for rounding.
    """
    yield None
    surfaces, is_moving = assemble_against_others(_near_meshes(assembly, movers), movers.names, movers.ignored)
    yield None
    return _part(surfaces, is_moving, movers, near)


def _part(surfaces: Assembly, is_moving: Flags, movers: _Movers, pairs: Sequence[tuple[int, int]]) -> Parting | None:
    """Translate the moving objects together by the least distance that parts all that they touch.

    None, with nothing changed, if something cuts deeper than rounding, or no translation of that size parts it. pairs:
    of triangles that are nearer than the gap.
    """
    free = _free_directions(movers.sets).along(np.eye(3))
    shift = find_parting(surfaces.surface, surfaces.positions, is_moving, movers.gap, free, pairs, movers.deepest)
    if shift is None or movers.are_keyed:
        return None
    for each in movers.sets:
        each.writer.write(each.controls + [shift, np.zeros(3)])
    bpy.context.view_layer.update()
    return Parting(movers.sets)


def _contacts_steps(
    snapshot: EditSnapshot, solver: EditSolver, movers: _Movers | None
) -> Steps[list[stiv.LeastDistance]]:
    """Steps that find the nearest contact of moving objects, unless a minimum distance is chosen; all that touch but
    for rounding.
    """
    if movers is None or not movers.are_alone or snapshot.settings.separation > 0 or not solver.has_session:
        return []
    if len(_near_meshes(snapshot.assembly, movers)) == len(movers.meshes):
        return []
    least = solver.session.least_distance()
    if least is None or not movers.are_near(least):
        return []
    if least.distance >= TOUCHING * movers.gap:
        return [least]
    yield None
    return _find_contacts(snapshot.assembly, movers)


@dataclass(frozen=True)
class _Movers:
    """Objects that move rigidly.

    Attributes:
        sets: their control sets.
        meshes: numbers of the meshes that move.
        names: of their objects.
        gap: the distance by which they are parted from what they touch.
        ignored: pairs of names that may intersect.
        are_alone: does nothing yield by deformation?
    """

    sets: tuple[ControlSet, ...]
    meshes: tuple[int, ...]
    names: frozenset[str]
    gap: float
    ignored: Pairs
    are_alone: bool

    @classmethod
    def of(cls, snapshot: EditSnapshot) -> _Movers | None:
        """Those of a snapshot; None if anything else moves, or if modifiers shape them where they are."""
        sets = tuple(each for each in snapshot.control_sets if each.rule.moves)
        if any(each.role != "rigid" or each.placed is not None for each in sets):
            return None
        assembly, settings = snapshot.assembly, snapshot.settings
        points = assembly.positions[find_moving_vertices(assembly, snapshot.control_sets)]
        if len(points) == 0:
            return None
        gap = GAP * max(rounding_of(SURPLUS * points), *map(_rounding_of_places, sets))
        meshes = tuple(index for each in sets for index in each.surfaces)
        names = frozenset(assembly.meshes[index].owner.name for index in meshes)
        passing = sorted(pairs_of_objects(settings.excluded))
        are_alone = all(each.role == "rigid" for each in snapshot.control_sets)
        return cls(sets, meshes, names, gap, (*settings.ignored_pairs, *passing), are_alone)

    @property
    def deepest(self) -> float:
        """The depth that still counts as touching, where the rounding of others is not larger."""
        return DEEPEST_LEFT / GAP * self.gap

    @property
    def are_keyed(self) -> bool:
        """Would the next frame reset any of them?"""
        return any(is_keyed(each.find()) for control_set in self.sets for each in _writer(control_set).references)

    def with_small_distance(self, snapshot: EditSnapshot) -> EditSnapshot:
        """A snapshot with a minimum distance that objects in contact already have, unless one is chosen.

        Otherwise all their faces would have the automatic one, except those that are nearer at the start: where others
        approach on the way, objects would rise, or get stuck.
        """
        if not self.are_alone or snapshot.settings.separation > 0:
            return snapshot
        return replace(snapshot, settings=replace(snapshot.settings, separation=KEPT * self.gap))

    def are_near(self, least: stiv.LeastDistance) -> bool:
        """Is a distance that of objects in contact?"""
        return least.distance <= NEAR * self.gap


def _find_contacts(assembly: Assembly, movers: _Movers) -> list[stiv.LeastDistance]:
    """The least distances of moving objects and others in contact with them, in ascending order."""
    found: list[stiv.LeastDistance] = []
    meshes = _near_meshes(assembly, movers)
    while len(found) < MOST_NEAR:
        surfaces, _ = assemble_against_others(meshes, movers.names, [*movers.ignored, *(each.bodies for each in found)])
        least = stiv.least_distance(surfaces.positions, surfaces.surface)
        if least is None or not movers.are_near(least):
            break
        found.append(least)
    return found


def _near_meshes(assembly: Assembly, movers: _Movers) -> list[VisibleMesh]:
    """The moving meshes, others whose boxes meet the box around them, and what obstacles have there."""
    boxes = [extents(assembly.positions[a:b]) if b > a else None for a, b in pairwise(assembly.starts.tolist())]
    own = [box for box in (boxes[index] for index in movers.meshes) if box is not None]
    low = np.min([box[0] for box in own], axis=0) - NEAR * movers.gap
    high = np.max([box[1] for box in own], axis=0) + NEAR * movers.gap
    near = [
        mesh
        for mesh, box in zip(assembly.meshes, boxes, strict=True)
        if mesh.owner.name in movers.names or (box is not None and (box[0] <= high).all() and (low <= box[1]).all())
    ]
    found = [(static, static.obstacle.triangles_near(low, high)) for static in assembly.obstacles]
    return [*near, *(static.cropped(rows) for static, rows in found if len(rows))]


def _writer(control_set: ControlSet) -> PlacementWriter:
    assert isinstance(control_set.writer, PlacementWriter)
    return control_set.writer


def _only_touch(error: ObjectsIntersectError, moving: frozenset[str], depth: float) -> bool:
    """Is each pair one of a moving and a resting object that only touch? depth: at least that of rounding there."""
    assembly, count = error.assembly, len(error.assembly.surface.triangles)
    is_moving = np.zeros(len(assembly.positions), np.bool_)
    is_moving[assembly.vertices_of([k for k, mesh in enumerate(assembly.meshes) if mesh.owner.name in moving])] = True
    moves = np.append(is_moving[assembly.surface.triangles[:, 0]], False)[np.minimum(error.pairs, count)]
    if len(moves) == 0 or (moves[:, 0] == moves[:, 1]).any():
        return False
    first, second = (_corners(assembly, error.pairs[:, side]) for side in (0, 1))
    return are_touching(first, second, max(depth, DEEPEST * rounding_of(np.concatenate([first, second]))))


def _corners(assembly: Assembly, triangles: Indices) -> Floats:
    """Corners of triangles of the surface or an obstacle, (n, 3, 3)."""
    corners, first = np.empty((len(triangles), 3, 3)), len(assembly.surface.triangles)
    own = triangles < first
    corners[own] = assembly.positions[assembly.surface.triangles[triangles[own]]]
    for static in assembly.obstacles:
        own = (triangles >= first) & (triangles < first + static.obstacle.triangle_count)
        points = static.shape.local[static.shape.triangles[triangles[own] - first]].astype(np.float64)
        corners[own] = transform_points(static.matrix, points.reshape(-1, 3)).reshape(-1, 3, 3)
        first += static.obstacle.triangle_count
    return corners


def _rounding_of_places(control_set: ControlSet) -> float:
    """That of the places of the objects, whose surfaces may be far from there."""
    starts = _writer(control_set).starts
    return rounding_of(np.array([(each.location, each.world[:3, 3]) for each in starts]))


def _free_directions(control_sets: Sequence[ControlSet]) -> FreeDirections:
    """The directions that the locks of all objects leave free."""
    free = ALL_FREE
    for rule in (each.rule for each in control_sets):
        free = free.within(rule.free if isinstance(rule, PlacementGoal) else None)
    return free
