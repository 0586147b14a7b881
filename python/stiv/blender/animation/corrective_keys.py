# SPDX-License-Identifier: GPL-3.0-or-later
"""Corrective shape keys for the frames that bones alone cannot correct."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from itertools import pairwise

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.animation.clip import Clip
from stiv.blender.animation.clip_solving import ClipSolver
from stiv.blender.controls.joined_seams import selection_weights
from stiv.blender.scene.animation_curves import own_curves
from stiv.blender.scene.arrays import Floats, Indices, Singles, read_collection
from stiv.blender.scene.references import ObjectReference

PROBE = 0.01  # offset of a key, in sizes of the mesh, that measures how modifiers move it
DIVISIONS = (1, 2, 4, 8)  # keys for each half frame; more where the motion between two of them would intersect
CLEARANCE = 3e-3  # sizes of the surface: shapes in contact would need a key at each small step of the motion
REST = 1e-6  # distance, in sizes of the surface, below which a vertex keeps its place


@dataclass(frozen=True, eq=False)
class Corrective:
    """A corrective shape key: the offsets of all vertices of a mesh, (n, 3), in its own frame.

    Its value is 1 at its moment, and 0 from the moments beside it on, which `fades` lists.
    """

    owner: ObjectReference
    moment: float
    fades: tuple[float, ...]
    offsets: Floats


@dataclass(frozen=True, eq=False)
class Shaped:
    """Corrective keys of a run of frames, and the surface, (N, 3), at each of its moments."""

    keys: list[Corrective]
    surfaces: dict[float, Floats]


class CorrectiveSolver:
    """Moves vertices of meshes out of the way while everything else follows the corrected animation."""

    def __init__(self, clip: Clip, solver: ClipSolver, correction_at: Callable[[float], Floats]) -> None:
        """correction_at: correction of the parts at a moment, (k,)."""
        self._clip, self._solver, self._correction_at = clip, solver, correction_at

    def solve(self, first: float, last: float, ends: tuple[int, int]) -> Shaped | None:
        """Keys for the moments from the first to the last one, between the first and the last frame of the clip.

        None if the vertices do not come free either. Raises InputError for a mesh that cannot get a shape key.
        """
        for steps in DIVISIONS:
            inside = [max(first - 0.5, ends[0]), min(last + 0.5, ends[1])]
            moments = np.arange(inside[0], inside[1] + 0.25 / steps, 0.5 / steps).tolist()
            if first == ends[0]:
                moments.reverse()  # from the free moment after them
            found = self._solve_at(moments, first > ends[0] and last < ends[1])
            if found is not None:
                return found
        return None

    def _solve_at(self, moments: Sequence[float], is_inside: bool) -> Shaped | None:
        """Keys at some moments, the first of which is free; the last one too if they are inside the clip."""
        goals = [self._mesh_at(moment) for moment in moments]
        meshes = self._yielding(goals)
        moved = self._follow(goals, meshes)
        if moved is None or (is_inside and np.abs(moved[-1] - goals[-1]).max() > REST * self._clip.size):
            return None
        surfaces = [points[self._clip.rows] for points in moved]
        if not all(self._solver.is_step_free(*pair) for pair in pairwise(surfaces)):
            return None
        keys = []
        for k, (points, goal) in enumerate(zip(moved, goals, strict=True)):
            fades = tuple(moments[j] for j in (k - 1, k + 1) if 0 <= j < len(moments))
            for owner, rows in meshes.items():
                offsets = (points - goal)[rows]
                if np.abs(offsets).max() > REST * self._clip.size:
                    keys.append(Corrective(owner, moments[k], fades, self._local(owner, rows, moments[k], offsets)))
        return Shaped(keys, dict(zip(moments, surfaces, strict=True)))

    def _mesh_at(self, moment: float) -> Floats:
        """World positions of all meshes, (n, 3)."""
        return self._clip.whole_mesh(moment, self._correction_at(moment))

    def _yielding(self, surfaces: Sequence[Floats]) -> dict[ObjectReference, Indices]:
        """The moving meshes that intersect, with their vertices."""
        rows = self._clip.rows
        names = {name for each in surfaces for pair in self._solver.intersections(each[rows]) for name in pair}
        names = names or {owner.name for owner in self._clip.moving_meshes}
        found = {owner: own for owner, own in self._clip.moving_meshes.items() if owner.name in names}
        for owner, own in found.items():
            check_mesh(owner.find(), len(own))
        return found

    def _follow(self, goals: Sequence[Floats], meshes: dict[ObjectReference, Indices]) -> list[Floats] | None:
        """Positions of all vertices at each goal, (n, 3); None if the rest of the scene cannot follow its animation."""
        rows, leaders, count = self._clip.rows, self._clip.leaders, len(goals[0])
        is_copy = (leaders != np.arange(count))[:, None]
        yielding = np.zeros(count, bool)
        for own in meshes.values():
            yielding[own] = True
        matrix = selection_weights(leaders[rows].astype(np.int32), count)
        separation = max(self._solver.settings.separation, CLEARANCE * self._clip.size)
        options = stiv.EditOptions(weights=yielding.astype(float), separation=separation)
        session = stiv.EditSession(self._solver.assembly.surface, stiv.linear(matrix), goals[0], options)
        found = [goals[0]]
        for goal in goals[1:]:
            if session.edit(goal).status not in ("reached", "unchanged"):
                session.settle()
            moved = session.controls
            points = np.where(is_copy, goal + (moved - goal)[leaders], moved)
            if not np.allclose(points[~yielding], goal[~yielding], rtol=0, atol=REST * self._clip.size):
                return None
            found.append(points)
        return found

    def _local(self, owner: ObjectReference, rows: Indices, moment: float, offsets: Floats) -> Floats:
        """Offsets of a key, (n, 3), that move the evaluated vertices by offsets in the world, (n, 3)."""
        ob = owner.find()
        with_key = _Probe(ob)
        try:
            ends = []
            for axis in (None, *np.eye(3)):
                with_key.move(axis)
                ends.append(self._mesh_at(moment)[rows])
        finally:
            with_key.remove()
        columns = np.stack([(end - ends[0]) / with_key.length for end in ends[1:]], axis=2)
        moved = np.abs(offsets).max(axis=1) > REST * self._clip.size
        if (np.abs(np.linalg.det(columns[moved])) < 1e-6).any():
            raise InputError(f"{ob.name}: a modifier hides its shape keys; apply it")
        local = np.zeros_like(offsets)
        local[moved] = np.linalg.solve(columns[moved], offsets[moved][:, :, None])[:, :, 0]
        return local


class _Probe:
    """A shape key that moves all vertices of a mesh alike."""

    def __init__(self, ob: bpy.types.Object) -> None:
        self._ob, self._had_keys = ob, ob.data.shape_keys is not None
        self._key = _new_key(ob, "Probe")
        self._rest = read_collection(ob.data.shape_keys.reference_key.data, "co", 3, np.float32)
        self.length = PROBE * (float(np.ptp(self._rest, axis=0).max()) or 1.0)
        self._key.value = 1

    def move(self, axis: Floats | None) -> None:
        """Offset all vertices along an axis, (3,)."""
        shift = np.zeros(3) if axis is None else self.length * axis
        _write_points(self._key, self._rest + shift.astype(np.float32))
        self._ob.data.update_tag()

    def remove(self) -> None:
        """Remove the key, and the reference key if the mesh had none."""
        self._ob.shape_key_remove(self._key)
        if not self._had_keys:
            self._ob.shape_key_clear()


def check_mesh(ob: bpy.types.Object, count: int) -> None:
    """Refuse a mesh that cannot get corrective keys for this many evaluated vertices. Raises InputError by name."""
    if ob.type != "MESH" or not ob.is_editable or ob.data.library is not None:
        raise InputError(f"{ob.name}: not a local mesh, so it can have no corrective key")
    if ob.data.users > 1:
        raise InputError(f"{ob.name}: shares its mesh; make it single-user for a corrective key")
    if len(ob.data.vertices) != count:
        raise InputError(f"{ob.name}: modifiers add vertices; a corrective key needs the mesh's own")
    if ob.data.shape_keys is not None and not ob.data.shape_keys.use_relative:
        raise InputError(f"{ob.name}: its shape keys are absolute; make them relative")
    if ob.show_only_shape_key:
        raise InputError(f"{ob.name}: shows one shape key alone; turn off Shape Key Lock")


def write_correctives(correctives: Sequence[Corrective]) -> None:
    """Write the keys and their values, linear over time."""
    for each in correctives:
        ob = each.owner.find()
        key = _new_key(ob, f"Corrective {each.moment:g}")
        rest = read_collection(ob.data.shape_keys.reference_key.data, "co", 3, np.float32)
        _write_points(key, rest + each.offsets.astype(np.float32))
        for moment in sorted((each.moment, *each.fades)):
            key.value = float(moment == each.moment)
            key.keyframe_insert("value", frame=moment)
        path = key.path_from_id("value")
        for curve in own_curves(ob.data.shape_keys):
            if curve.data_path == path:
                for point in curve.keyframe_points:
                    point.interpolation = "LINEAR"
                curve.update()


def _new_key(ob: bpy.types.Object, name: str) -> bpy.types.ShapeKey:
    if ob.data.shape_keys is None:
        ob.shape_key_add(name="Basis", from_mix=False)
    key = ob.shape_key_add(name=name, from_mix=False)
    key.relative_key = ob.data.shape_keys.reference_key
    return key


def _write_points(key: bpy.types.ShapeKey, points: Singles) -> None:
    key.data.foreach_set("co", points.astype(np.float32).ravel())


def runs_of(places: Collection[int]) -> list[tuple[int, int]]:
    """First and last number of each run of consecutive numbers."""
    ordered = sorted(places)
    breaks = [k for k, (one, other) in enumerate(pairwise(ordered)) if other > one + 1]
    firsts = [0, *(k + 1 for k in breaks)]
    lasts = [*breaks, len(ordered) - 1]
    return [(ordered[a], ordered[b]) for a, b in zip(firsts, lasts, strict=True)] if ordered else []
