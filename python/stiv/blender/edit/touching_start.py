# SPDX-License-Identifier: GPL-3.0-or-later
"""Starts an edit of objects that touch others, such as a crate on the floor: it parts them first, by rounding."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import bpy
import numpy as np

from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.directions import ALL_FREE, FreeDirections
from stiv.blender.controls.editable import is_keyed
from stiv.blender.controls.placement_goals import PlacementGoal
from stiv.blender.controls.placement_writer import PlacementWriter
from stiv.blender.edit.sessions import ObjectsIntersectError, restore_controls
from stiv.blender.edit.snapshot import EditSnapshot
from stiv.blender.edit.solver import EditSolver, start_solver_steps
from stiv.blender.excluded_faces import Exclusions
from stiv.blender.scene.assembly import assemble_against_others
from stiv.blender.scene.elements import PART
from stiv.blender.scene.near_assembly import near_assembly
from stiv.blender.scene.references import SceneChangedError
from stiv.task import Steps
from stiv.touching import are_touching, find_parting, rounding_of

GAP = 8  # between parted objects, in roundings of what moves
KEPT = 0.5  # of the gap: their minimum distance, so that they keep the gap

Started = tuple[EditSnapshot, EditSolver, "Parting | None"]


@dataclass(frozen=True)
class Parting:
    """Objects that a start has parted from those that they touched.

    Attributes:
        control_sets: of these objects; their start is the one before.
        touched: pairs of names of objects that touched.
        gap: distance by which they are parted.
    """

    control_sets: tuple[ControlSet, ...]
    touched: tuple[tuple[str, str], ...]
    gap: float

    def restore(self) -> None:
        """Restore the objects exactly. Raises SceneChangedError if one was removed."""
        restore_controls(self.control_sets)

    def adapted(self, snapshot: EditSnapshot) -> EditSnapshot:
        """A snapshot of the parted objects that keeps their gap, unless a minimum distance is chosen.

        Otherwise they would rise by the automatic one on their way, where other faces come near.
        """
        settings = snapshot.settings
        if settings.separation > 0:
            return snapshot
        chosen = {frozenset(names) for *names, _ in settings.pair_separations}
        rows = [(*names, KEPT * self.gap) for names in self.touched if frozenset(names) not in chosen]
        return replace(snapshot, settings=replace(settings, pair_separations=(*settings.pair_separations, *rows)))


def start_apart_steps(read: Callable[[], Steps[EditSnapshot]]) -> Steps[Started]:
    """Steps that read the scene and start a solver, after parting moving objects that only touch others.

    read: makes steps that read the scene. Raise InputError and StartIntersectsError, with nothing changed.
    """
    snapshot = yield from read()
    try:
        return snapshot, (yield from start_solver_steps(snapshot)), None
    except ObjectsIntersectError as error:
        parting = yield from _part_steps(snapshot, error)
        if parting is None:
            raise
        refusal = error
    try:
        parted = parting.adapted((yield from read()))
        return parted, (yield from start_solver_steps(parted)), parting
    except BaseException as error:  # also where a caller ends the steps
        with suppress(SceneChangedError):
            parting.restore()
        if isinstance(error, ObjectsIntersectError):
            raise refusal from None
        raise


def _part_steps(snapshot: EditSnapshot, error: ObjectsIntersectError) -> Steps[Parting | None]:
    """Steps that translate the moving objects together until they touch no others; None, with nothing changed, if they
    cut deeper, or no translation of the size of rounding parts them.
    """
    sets = tuple(each for each in snapshot.control_sets if each.rule.moves)
    if not all(map(_may_part, sets)):
        return None
    meshes, settings = snapshot.assembly.meshes, snapshot.settings
    moving = frozenset(meshes[index].owner.name for each in sets for index in each.surfaces)
    if not _only_touch(error, moving):
        return None
    yield None
    near = near_assembly(error.assembly, error.assembly.positions).assembly
    ignored = [*settings.ignored_pairs, *_excluded_objects(settings.excluded)]
    surfaces, is_moving = assemble_against_others(near.meshes, moving, ignored)
    yield None
    gap = GAP * max(rounding_of(surfaces.positions[is_moving]), *map(_rounding_of_places, sets))
    free = _free_directions(sets).along(np.eye(3))
    shift = find_parting(surfaces.surface, surfaces.positions, is_moving, gap, free, settings.threads)
    if shift is None:
        return None
    for each in sets:
        each.writer.write(each.controls + [shift, np.zeros(3)])
    bpy.context.view_layer.update()
    touched = tuple((first, second) for first, second, _ in error.objects)
    return Parting(sets, touched, gap)


def _may_part(control_set: ControlSet) -> bool:
    """Do objects move rigidly, wherever they are, and stay where they are moved to?"""
    objects = [reference.find() for reference in _writer(control_set).references] if control_set.role == "rigid" else []
    return bool(objects) and control_set.placed is None and not any(map(is_keyed, objects))


def _writer(control_set: ControlSet) -> PlacementWriter:
    assert isinstance(control_set.writer, PlacementWriter)
    return control_set.writer


def _only_touch(error: ObjectsIntersectError, moving: frozenset[str]) -> bool:
    """Is each pair one of a moving and a resting object that only touch? Those with obstacles are tested later."""
    assembly, count = error.assembly, len(error.assembly.surface.triangles)
    is_moving = np.zeros(len(assembly.positions), np.bool_)
    is_moving[assembly.vertices_of([k for k, mesh in enumerate(assembly.meshes) if mesh.owner.name in moving])] = True
    moves = np.append(is_moving[assembly.surface.triangles[:, 0]], False)[np.minimum(error.pairs, count)]
    if len(moves) == 0 or (moves[:, 0] == moves[:, 1]).any():
        return False
    corners = assembly.positions[assembly.surface.triangles[error.pairs[(error.pairs < count).all(axis=1)]]]
    return are_touching(corners[:, 0], corners[:, 1])


def _excluded_objects(excluded: Exclusions) -> list[tuple[str, str]]:
    """Names of the pairs of objects with excluded faces, which may overlap."""
    return [(a.partition(PART)[0], b.partition(PART)[0]) for a, b in excluded.objects]


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
