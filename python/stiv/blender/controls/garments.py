# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes that yield while bones move: cages, soft handles or lattices, written into copies that follow the pose."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any

import bpy
import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.cage import make_cage_set
from stiv.blender.controls.control_set import ControlSet, Participant, ShownAs, Writer
from stiv.blender.controls.handles import make_handle_sets
from stiv.blender.controls.joined_seams import followed_controls, join_controls
from stiv.blender.controls.lattice_points import check_lattice, make_lattice_set
from stiv.blender.controls.stack_jacobian import PROBE, find_frames_steps
from stiv.blender.controls.subdivision import identity_weights
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings
from stiv.task import Steps, run

STEP = 0.01  # of differences, in sizes of the garment
LEAST_WEIGHT = 1e-3  # of a measured weight, so that the Jacobian stays sparse
Evaluate = Callable[[Floats], Floats | None]  # from all controls, (m, 3), to all positions, (n, 3)


@dataclass(frozen=True)
class Blocks:
    """Derivatives, (b, 3, 3), of vertices, (b,), by controls, (b,)."""

    rows: Indices
    controls: Indices
    data: Floats


@dataclass(frozen=True)
class Garment:
    """An object whose controls yield.

    Attributes:
        controls: the control set as without bones; its deformation holds at the pose of the start only.
        weights: with which each vertex follows the controls, (n, m); None: to be measured.
    """

    controls: ControlSet
    weights: stiv.Weights | None

    def write_copy(self, copy: bpy.types.Object, controls: Floats) -> None:
        """Write controls, (m, 3), into a copy of the object."""
        _aimed_at(self.controls.writer, ObjectReference.of(copy)).write(controls)

    def blocks(self, evaluate: Evaluate, controls: Floats, rows: Indices) -> Blocks:
        """The derivative of the surface at the present pose.

        evaluate: positions of all vertices from the controls of this garment. rows: its vertices among them.
        """
        return run(self.blocks_steps(evaluate, controls, rows))

    def blocks_steps(self, evaluate: Evaluate, controls: Floats, rows: Indices) -> Steps[Blocks]:
        """Steps of `blocks`, which give a turn after a few evaluations."""
        step = STEP * (float(np.ptp(controls, axis=0).max()) or 1.0)
        frames = yield from find_frames_steps(lambda moved: _rows_of(evaluate(moved), rows), controls, step)
        weights = self.weights or (yield from _measured_weights(evaluate, controls, rows, step))
        if frames is None:  # unknown where the topology changes: as if the garment kept its frame
            frames = np.broadcast_to(np.eye(3), (len(rows), 3, 3))
        own = np.repeat(np.arange(len(rows), dtype=np.int32), np.diff(weights.indptr))
        return Blocks(rows[own], weights.indices, weights.data[:, None, None] * frames[own])


def rows_of_blocks(found: Sequence[Blocks], count: int, chosen: Indices) -> tuple[Indices, Indices, Floats]:
    """Chosen rows, which may repeat, of the matrix of all blocks, in CSR format. count: of its rows."""
    rows = np.concatenate([each.rows for each in found])
    order = np.lexsort((np.concatenate([each.controls for each in found]), rows))
    starts = np.append(0, np.cumsum(np.bincount(rows, minlength=count)))
    lengths = np.diff(starts)[chosen]
    indptr = np.append(0, np.cumsum(lengths)).astype(np.int32)
    picked = order[np.arange(indptr[-1]) + np.repeat(starts[:-1][chosen] - indptr[:-1], lengths)]
    columns = np.concatenate([each.controls for each in found])[picked].astype(np.int32)
    return indptr, columns, np.concatenate([each.data for each in found])[picked]


def make_garments(
    context: bpy.types.Context,
    participants: Sequence[Participant],
    meshes: Sequence[VisibleMesh],
    settings: EditSettings,
) -> list[Garment]:
    """The garments of participants with the roles "cage", "soft" or "lattice". Raises InputError by name."""
    found: list[Garment] = []
    for each in participants:
        found += _lattice(each, meshes, settings) if each.role == "lattice" else _mesh(context, each, meshes, settings)
    owners = [meshes[index].owner.name for each in found for index in each.controls.surfaces]
    for name in owners:
        if owners.count(name) > len([mesh for mesh in meshes if mesh.owner.name == name]):
            raise InputError(f"{name}: moves, and so does its lattice; let one of them yield")
    return found


def stacked_weights(weights: Sequence[Floats]) -> Floats:
    """Weights of several sets of controls, (m,), or (m, 3) if any set has weights along axes."""
    if all(each.ndim == 1 for each in weights):
        return np.concatenate(list(weights))
    return np.concatenate([np.broadcast_to(each.reshape(len(each), -1), (len(each), 3)) for each in weights])


def _mesh(
    context: bpy.types.Context, participant: Participant, meshes: Sequence[VisibleMesh], settings: EditSettings
) -> list[Garment]:
    name = participant.reference.name
    if participant.role not in ("cage", "soft"):
        raise InputError(f"{name}: only meshes and lattices yield to a pose; set its role to Obstacle")
    if name in settings.loops:
        raise InputError(f"{name}: Loop subdivision does not yield to a pose; use a lattice")
    surfaces = tuple(index for index, mesh in enumerate(meshes) if mesh.owner.name == name)
    if not surfaces:
        raise InputError(f"{name}: it has no visible surface; show it")
    shown = [ShownAs(name, meshes[index].read_from) for index in surfaces]
    if participant.role == "soft":
        handles = make_handle_sets(participant, surfaces, shown, context.scene, settings)
        return [Garment(each, None) for each in handles]
    cage = join_controls(make_cage_set(participant, surfaces, shown, context.scene, settings), meshes)
    return [Garment(cage, _known_weights(cage))]


def _known_weights(cage: ControlSet) -> stiv.Weights:
    if cage.observed is not None:
        followed = followed_controls(cage)
        counts = np.diff(followed.indptr)
        return replace(followed, data=followed.data / np.repeat(np.maximum(counts, 1), counts))
    try:
        return stiv.linear_weights(cage.deformation)[0]
    except InputError:  # the identity has none
        return identity_weights(len(cage.controls))


def _lattice(participant: Participant, meshes: Sequence[VisibleMesh], settings: EditSettings) -> list[Garment]:
    lattice = participant.reference.find()
    check_lattice(lattice)
    surfaces = tuple(index for index, mesh in enumerate(meshes) if _is_deformed_by(mesh.owner.find(), lattice))
    if not surfaces:
        raise InputError(f"{lattice.name}: the lattice deforms no visible mesh; show one")
    unused = stiv.identity(len(lattice.data.points))
    return [Garment(make_lattice_set(participant, surfaces, unused, settings), None)]


def _is_deformed_by(ob: bpy.types.Object, lattice: bpy.types.Object) -> bool:
    return any(isinstance(each, bpy.types.LatticeModifier) and each.object == lattice for each in ob.modifiers)


def _measured_weights(evaluate: Evaluate, controls: Floats, rows: Indices, step: float) -> Steps[stiv.Weights]:
    """Steps to weights by moving each control alone; they sum to 1 for each vertex that follows any."""
    here = evaluate(controls)
    lengths = np.zeros((len(rows), len(controls)))
    for number in range(len(controls)):
        moved = controls.copy()
        moved[number] += step * PROBE
        there = evaluate(moved)
        yield None
        if here is not None and there is not None:
            lengths[:, number] = np.linalg.norm((there - here)[rows], axis=1)
    lengths /= np.maximum(lengths.sum(axis=1, keepdims=True), np.finfo(np.float64).tiny)
    lengths[lengths < LEAST_WEIGHT] = 0
    row, column = np.nonzero(lengths)
    indptr = np.append(0, np.cumsum(np.bincount(row, minlength=len(rows)))).astype(np.int32)
    return stiv.Weights(indptr, column.astype(np.int32), lengths[row, column], lengths.shape)


def _rows_of(positions: Floats | None, rows: Indices) -> Floats | None:
    return None if positions is None else positions[rows]


def _aimed_at(writer: Any, copy: ObjectReference) -> Writer:
    """The writer of a copy instead of the object, and so the writers in it."""
    changed: dict[str, Any] = {}
    for each in fields(writer):
        value = getattr(writer, each.name)
        if isinstance(value, ObjectReference):
            changed[each.name] = copy
        elif is_dataclass(value) and hasattr(value, "restore") and each.name != "keys":
            changed[each.name] = _aimed_at(value, copy)
    aimed: Writer = replace(writer, **changed)
    return aimed
