# SPDX-License-Identifier: GPL-3.0-or-later
"""Seams of meshes that deform: vertices in one place stay together, and are one vertex of the surface."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.cage import read_cage
from stiv.blender.controls.control_set import Part, Writer
from stiv.blender.controls.control_weights import pinned_directions
from stiv.blender.controls.points import PointGoal
from stiv.blender.scene.arrays import Flags, Floats, Indices
from stiv.blender.scene.assembly import mesh_seams
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.mesh_reading import read_triangles
from stiv.seams import Seams

DRIFT = 1e-6  # of what controls move: by so much less copies move apart where they follow the same controls


@dataclass(frozen=True)
class TiedWriter:
    """Writes a cage of which some vertices are one control."""

    writer: Writer
    tied: Seams

    def write(self, controls: Floats) -> None:
        """Write world positions of the controls, (m, 3), each to all its vertices."""
        self.writer.write(controls[self.tied.index])

    def restore(self) -> None:
        """Write the original positions."""
        self.writer.restore()


def join_part(part: Part, meshes: Sequence[VisibleMesh]) -> Part:
    """A part with the seams of the meshes that it deforms kept closed; the part itself where there are none."""
    if part.role == "rigid":
        return part  # what keeps its shape is not tested against itself
    shown = [meshes[index] for index in part.surfaces]
    found = [mesh_seams(mesh.local, mesh.triangles) for mesh in shown]
    if all(each is None for each in found):
        return part
    if part.role == "cage":
        part = _tied(part, _stacked_vertices(found, shown))
    seams = _kept(part, found, [len(mesh.local) for mesh in shown])
    if all(each is None for each in seams):
        return part
    firsts, count = [], 0
    for each, mesh in zip(seams, shown, strict=True):
        first = np.arange(len(mesh.local), dtype=np.int32) if each is None else each.first
        firsts.append(first + count)
        count += len(mesh.local)
    return replace(part, deformation=_limited(part, np.concatenate(firsts)), seams=seams)


def copied(deformation: stiv.Deformation, tied: Seams) -> stiv.Deformation:
    """The deformation of the vertices of a mesh from that of the mesh with its seams joined."""
    return stiv.compose(_one_of_each(tied.index, len(tied.first)), deformation)


def joined_rows(rows: Indices, tied: Seams | None) -> Indices:
    """Triangles or edges, (f, k), over the joined vertices; those of which two corners are one are left out."""
    if tied is None:
        return rows
    joined = tied.index[rows]
    proper: Indices = joined[(joined != np.roll(joined, 1, axis=1)).all(axis=1)]
    return proper


def seam_note(name: str, selected: Flags, tied: Seams) -> str:
    """Tells where some vertices of a seam are selected, (n,), and others follow them; "" where none do."""
    follow = int(((np.bincount(tied.index, selected) > 0)[tied.index] & ~selected).sum())
    return f'object "{name}": {follow} vertices follow those selected on their seams' if follow else ""


def _one_of_each(index: Indices, count: int) -> stiv.Weights:
    """The weights, (n, count), by which each row is one of `count` points: that at `index`, (n,)."""
    return stiv.Weights(np.arange(len(index) + 1, dtype=np.int32), index, np.ones(len(index)), (len(index), count))


def _stacked_vertices(found: Sequence[Seams | None], shown: Sequence[VisibleMesh]) -> Flags:
    """Which vertices of all shown meshes, one after the other, are on a seam."""
    flags = []
    for seams, mesh in zip(found, shown, strict=True):
        if seams is None:
            flags.append(np.zeros(len(mesh.local), np.bool_))
        else:
            flags.append(np.bincount(seams.index)[seams.index] > 1)
    return np.concatenate(flags)


def _tied(part: Part, on_seam: Flags) -> Part:
    """The part of a cage with one control for vertices in one place that a seam of the shown meshes follows."""
    rule = part.rule
    assert isinstance(rule, PointGoal)
    mesh = bpy.data.objects[part.names[0]].data
    candidates = mesh_seams(read_cage(bpy.data.objects[part.names[0]]), read_triangles(mesh)[0])
    if candidates is None:
        return part
    weights = _weights(part.deformation)
    rows = np.repeat(on_seam, np.diff(weights.indptr))
    follows = np.zeros(len(part.controls), np.bool_)
    follows[weights.indices[rows]] = True
    follows = np.bincount(candidates.index, follows)[candidates.index] > 0
    tied = candidates.limited_to(follows)
    if tied is None:
        return part
    given = np.full((len(tied.first), *part.given.shape[1:]), np.inf)
    np.minimum.at(given, tied.index, part.given)  # what is pinned anywhere is pinned
    selected = np.bincount(tied.index, rule.selected) > 0
    response = np.zeros_like(given)
    np.maximum.at(response, tied.index, part.weights)
    return replace(
        part,
        deformation=stiv.linear(_tied_weights(weights, tied), _offset(part.deformation)),
        controls=part.controls[tied.first],
        weights=np.where(given > 0, response, 0.0),
        given=given,
        rule=_tied_rule(rule, selected, given, tied),
        writer=TiedWriter(part.writer, tied),
        tied=tied,
        note=seam_note(part.names[0], rule.selected, tied),
        weight_axes=None if part.weight_axes is None else part.weight_axes[tied.first],
    )


def _tied_rule(rule: PointGoal, selected: Flags, given: Floats, tied: Seams) -> PointGoal:
    free = None if rule.free is None else np.asarray((given > 0).reshape(len(given), -1).any(axis=1))
    edges = None if rule.edges is None else tied.index[rule.edges]
    pinned = None if rule.pinned is None else pinned_directions(given, rule.pinned.directions)
    selected = selected if free is None else selected & free
    return PointGoal(selected, rule.start[tied.first], edges, rule.origin, free, pinned)


def _kept(part: Part, found: Sequence[Seams | None], counts: Sequence[int]) -> tuple[Seams | None, ...]:
    """The seams that stay closed however the controls move: where copies follow the same controls.

    Told by motions of the controls at random: copies of other weights do not move alike.
    """
    size = float(np.ptp(part.controls, axis=0).max(initial=0.0)) or 1.0
    random = np.random.default_rng(0).uniform(-1, 1, part.controls.shape) * 0.01 * size
    moved = part.deformation.surface(part.controls + random) - part.deformation.surface(part.controls)
    kept: list[Seams | None] = []
    for seams, motion in zip(found, np.split(moved, np.cumsum(counts)[:-1]), strict=True):
        if seams is None:
            kept.append(None)
            continue
        apart = np.abs(motion - motion[seams.leaders]).max(axis=1)
        kept.append(seams.limited_to(apart <= DRIFT * np.abs(moved).max(initial=0.0)))
    return tuple(kept)


def _weights(deformation: stiv.Deformation) -> stiv.Weights:
    """The weights of a linear deformation; those of the identity too."""
    try:
        return stiv.linear_weights(deformation)[0]
    except InputError:
        return _one_of_each(np.arange(deformation.vertex_count, dtype=np.int32), deformation.control_count)


def _tied_weights(weights: stiv.Weights, tied: Seams) -> stiv.Weights:
    columns: Indices = tied.index[weights.indices]
    return stiv.Weights(weights.indptr, columns, weights.data, (weights.shape[0], len(tied.first)))


def _limited(part: Part, rows: Indices) -> stiv.Deformation:
    """The part's deformation of some vertices of its meshes; the identity where each is a control of its own."""
    chosen = _one_of_each(rows, part.deformation.vertex_count)
    if part.role == "soft":
        return stiv.compose(chosen, part.deformation)
    try:
        limited = stiv.compose(chosen, part.deformation)
    except InputError:
        return stiv.linear(chosen)  # of the identity
    weights, offset = stiv.linear_weights(limited)
    own = np.arange(len(part.controls))
    plain = offset is None and np.array_equal(weights.indices, own) and (weights.data == 1).all()
    return stiv.identity(len(own)) if plain and len(rows) == len(own) else limited


def _offset(deformation: stiv.Deformation) -> Floats | None:
    try:
        return stiv.linear_weights(deformation)[1]
    except InputError:
        return None
