# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps seams of deforming meshes closed: coincident vertices share a control, and are one vertex of the surface."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.control_set import ControlSet, Writer
from stiv.blender.controls.control_weights import pinned_directions
from stiv.blender.controls.points import PointGoal
from stiv.blender.scene.arrays import Flags, Floats, Indices
from stiv.blender.scene.assembly import mesh_seams
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.mesh_reading import read_cage, read_triangles
from stiv.seams import Seams

DRIFT = 1e-6  # of the controls' motion: maximum distance between copies that follow the same controls
OBSERVED_DRIFT = 1e-4  # the same for positions in single precision


@dataclass(frozen=True)
class SeamWriter:
    """Writes a cage in which some vertices share a control."""

    writer: Writer
    control_seams: Seams

    def write(self, controls: Floats) -> None:
        """Write world positions of the controls, (m, 3), to all their vertices."""
        self.writer.write(controls[self.control_seams.index])

    def restore(self) -> None:
        """Write the original positions."""
        self.writer.restore()


def join_seams(control_set: ControlSet, meshes: Sequence[VisibleMesh]) -> ControlSet:
    """The control set with the seams of its meshes kept closed; unchanged if there are none."""
    if control_set.role == "rigid":
        return control_set  # a rigid mesh is not tested against itself
    shown = [meshes[index] for index in control_set.surfaces]
    found = [mesh_seams(mesh.local, mesh.triangles) for mesh in shown]
    if all(each is None for each in found) and not _is_welded(control_set):
        return control_set
    if control_set.role == "cage":
        control_set = _merge_controls(control_set, _seam_flags(found, shown))
    seams = _closed_seams(control_set, found, [len(mesh.local) for mesh in shown])
    if all(each is None for each in seams):
        return control_set
    rows = first_copies(seams, [len(mesh.local) for mesh in shown])
    return replace(control_set, deformation=_restrict(control_set, rows), seams=seams)


def join_controls(cage: ControlSet, meshes: Sequence[VisibleMesh]) -> ControlSet:
    """The control set of a cage with one control for all copies on the seams of its meshes; unchanged without any."""
    shown = [meshes[index] for index in cage.surfaces]
    found = [mesh_seams(mesh.local, mesh.triangles) for mesh in shown]
    if all(each is None for each in found) and not _is_welded(cage):
        return cage
    return _merge_controls(cage, _seam_flags(found, shown))


def followed_controls(cage: ControlSet) -> stiv.Weights:
    """The controls that each vertex of an observed cage follows, (n, m), each of them once."""
    assert cage.observed is not None
    followed, seams = cage.observed.followed, cage.control_seams
    if seams is None:
        return followed
    rows = np.repeat(np.arange(followed.shape[0]), np.diff(followed.indptr))
    row, column = np.unique(np.stack([rows, seams.index[followed.indices]]), axis=1).astype(np.int32)
    indptr = np.append(0, np.cumsum(np.bincount(row, minlength=followed.shape[0]))).astype(np.int32)
    return stiv.Weights(indptr, column, np.ones(len(column)), (followed.shape[0], len(seams.first)))


def first_copies(seams: Sequence[Seams | None], counts: Sequence[int]) -> Indices:
    """Numbers of the vertices that remain of meshes with these numbers of vertices, stacked, on closed seams."""
    rows, first = [], 0
    for each, count in zip(seams, counts, strict=True):
        rows.append(first + (np.arange(count, dtype=np.int32) if each is None else each.first))
        first += count
    return np.concatenate(rows)


def copy_to_seams(deformation: stiv.Deformation, control_seams: Seams) -> stiv.Deformation:
    """Deformation of all vertices, from that of the mesh with merged seams."""
    return stiv.compose(selection_weights(control_seams.index, len(control_seams.first)), deformation)


def join_rows(rows: Indices, control_seams: Seams | None) -> Indices:
    """Triangles or edges, (f, k), with numbers of merged vertices; degenerate ones are left out."""
    if control_seams is None:
        return rows
    joined = control_seams.index[rows]
    proper: Indices = joined[(joined != np.roll(joined, 1, axis=1)).all(axis=1)]
    return proper


def seam_message(name: str, selected: Flags, control_seams: Seams) -> str:
    """Message about vertices that follow selected copies on a seam, (n,); "" if there are none."""
    follow = int(((np.bincount(control_seams.index, selected) > 0)[control_seams.index] & ~selected).sum())
    counted = "1 vertex follows" if follow == 1 else f"{follow:,} vertices follow"
    return f"{name}: {counted} on its seams" if follow else ""


def join_notes(*notes: str) -> str:
    """All notes that are not empty."""
    return "; ".join(note for note in notes if note)


def selection_weights(index: Indices, count: int) -> stiv.Weights:
    """Weights, (n, count), of rows that each equal one of `count` points, given by `index`, (n,)."""
    return stiv.Weights(np.arange(len(index) + 1, dtype=np.int32), index, np.ones(len(index)), (len(index), count))


def _is_welded(control_set: ControlSet) -> bool:
    """Does a modifier merge vertices of the mesh?"""
    return control_set.observed is not None and control_set.observed.leaders is not None


def _seam_flags(found: Sequence[Seams | None], shown: Sequence[VisibleMesh]) -> Flags:
    """Flags of the vertices of all meshes, stacked, that are on a seam."""
    flags = []
    for seams, mesh in zip(found, shown, strict=True):
        if seams is None:
            flags.append(np.zeros(len(mesh.local), np.bool_))
        else:
            flags.append(np.bincount(seams.index)[seams.index] > 1)
    return np.concatenate(flags)


def _merge_controls(control_set: ControlSet, on_seam: Flags) -> ControlSet:
    """The cage's control set with one control for the coincident vertices that a seam of its meshes follows."""
    rule = control_set.rule
    assert isinstance(rule, PointGoal)
    weights = _weights(control_set)
    control_seams = _find_control_seams(control_set, weights, on_seam)
    if control_seams is None:
        return control_set
    max_weights = np.full((len(control_seams.first), *control_set.max_weights.shape[1:]), np.inf)
    np.minimum.at(max_weights, control_seams.index, control_set.max_weights)  # pinned if any copy is
    selected = np.bincount(control_seams.index, rule.selected) > 0
    response = np.zeros_like(max_weights)
    np.maximum.at(response, control_seams.index, control_set.weights)
    return replace(
        control_set,
        deformation=_merged_deformation(control_set, weights, control_seams),
        controls=control_set.controls[control_seams.first],
        weights=np.where(max_weights > 0, response, 0.0),
        max_weights=max_weights,
        rule=_merge_rule(rule, selected, max_weights, control_seams),
        writer=SeamWriter(control_set.writer, control_seams),
        control_seams=control_seams,
        note=join_notes(control_set.note, seam_message(control_set.names[0], rule.selected, control_seams)),
        weight_axes=None if control_set.weight_axes is None else control_set.weight_axes[control_seams.first],
    )


def _find_control_seams(control_set: ControlSet, weights: stiv.Weights, on_seam: Flags) -> Seams | None:
    """The coincident vertices of a cage that a seam of its meshes follows, or those that a modifier merges."""
    if control_set.observed is not None and control_set.observed.leaders is not None:
        return Seams.of(control_set.observed.leaders)
    ob = bpy.data.objects[control_set.names[0]]
    candidates = mesh_seams(read_cage(ob), read_triangles(ob.data)[0])
    if candidates is None:
        return None
    follows = np.zeros(len(control_set.controls), np.bool_)
    follows[weights.indices[np.repeat(on_seam, np.diff(weights.indptr))]] = True
    return candidates.limited_to(np.bincount(candidates.index, follows)[candidates.index] > 0)


def _merge_rule(rule: PointGoal, selected: Flags, max_weights: Floats, control_seams: Seams) -> PointGoal:
    free = None if rule.free is None else np.asarray((max_weights > 0).reshape(len(max_weights), -1).any(axis=1))
    edges = None if rule.edges is None else control_seams.index[rule.edges]
    pinned = None if rule.pinned is None else pinned_directions(max_weights, rule.pinned.directions)
    selected = selected if free is None else selected & free
    return PointGoal(selected, rule.start[control_seams.first], edges, rule.frame, free, pinned)


def _closed_seams(
    control_set: ControlSet, found: Sequence[Seams | None], counts: Sequence[int]
) -> tuple[Seams | None, ...]:
    """The seams whose copies follow the same controls, and so stay closed for any motion.

    Tested with a random motion of the controls: copies with different weights move apart.
    """
    size = float(np.ptp(control_set.controls, axis=0).max(initial=0.0)) or 1.0
    random = np.random.default_rng(0).uniform(-1, 1, control_set.controls.shape) * 0.01 * size
    moved = _motion(control_set, random)
    drift = (DRIFT if control_set.observed is None else OBSERVED_DRIFT) * float(np.abs(moved).max(initial=0.0))
    motions = np.split(moved, np.cumsum(counts)[:-1])
    return tuple(seams and seams.limited_to_equal(motion, drift) for seams, motion in zip(found, motions, strict=True))


def _motion(control_set: ControlSet, move: Floats) -> Floats:
    """Motion of the surface, (n, 3), for one of the controls, (m, 3); for a shorter one where the topology changes."""
    start = control_set.deformation.surface(control_set.controls)
    for fraction in (1.0, 0.1, 0.01):
        with suppress(stiv.InfeasibleError):
            return np.asarray(control_set.deformation.surface(control_set.controls + fraction * move) - start)
    return np.zeros_like(start)


def _weights(control_set: ControlSet) -> stiv.Weights:
    """Weights of a linear deformation, including the identity; for observed stacks the controls that they follow."""
    if control_set.observed is not None:
        return control_set.observed.followed
    deformation = control_set.deformation
    try:
        return stiv.linear_weights(deformation)[0]
    except InputError:
        return selection_weights(np.arange(deformation.vertex_count, dtype=np.int32), deformation.control_count)


def _merged_deformation(control_set: ControlSet, weights: stiv.Weights, control_seams: Seams) -> stiv.Deformation:
    """The deformation of a cage by its merged controls."""
    if control_set.observed is not None:
        merged = selection_weights(control_seams.index, len(control_seams.first))
        return control_set.observed.deformation_of(stiv.linear(merged))
    return stiv.linear(_merge_columns(weights, control_seams), _offset(control_set.deformation))


def _merge_columns(weights: stiv.Weights, control_seams: Seams) -> stiv.Weights:
    columns: Indices = control_seams.index[weights.indices]
    return stiv.Weights(weights.indptr, columns, weights.data, (weights.shape[0], len(control_seams.first)))


def _restrict(control_set: ControlSet, rows: Indices) -> stiv.Deformation:
    """The deformation restricted to some vertices; the identity if each of them is a control."""
    chosen = selection_weights(rows, control_set.deformation.vertex_count)
    if control_set.role in ("soft", "curve") or control_set.observed is not None:
        return stiv.compose(chosen, control_set.deformation)
    try:
        limited = stiv.compose(chosen, control_set.deformation)
    except InputError:
        return stiv.linear(chosen)  # of the identity
    weights, offset = stiv.linear_weights(limited)
    own = np.arange(len(control_set.controls))
    plain = offset is None and np.array_equal(weights.indices, own) and (weights.data == 1).all()
    return stiv.identity(len(own)) if plain and len(rows) == len(own) else limited


def _offset(deformation: stiv.Deformation) -> Floats | None:
    try:
        return stiv.linear_weights(deformation)[1]
    except InputError:
        return None
