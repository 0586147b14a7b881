# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformation of a mesh by any modifiers: the part that Blender evaluates, and an exact subdivision after it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

import stiv
from stiv.blender.controls.affine_stack import Rows
from stiv.blender.controls.held_vertices import HeldVertices, find_held_vertices
from stiv.blender.controls.stack_block import BlockSettings, StackBlock
from stiv.blender.controls.stack_refusals import check_projections
from stiv.blender.controls.subdivision import (
    identity_deformation,
    identity_weights,
    moved_columns,
    stack_deformations,
    stack_weights,
)
from stiv.blender.scene.arrays import Floats, Indices, to_local
from stiv.blender.scene.stack_twin import kept_twins
from stiv.task import Steps, Turns


@dataclass(frozen=True)
class ShownStack:
    """A surface that shows a mesh.

    Attributes:
        ob: the object that shows it; of a shared mesh, any user.
        evaluation: where it was read.
        cage: from the controls to the vertices, by shape keys; None for the identity.
    """

    ob: bpy.types.Object
    evaluation: str
    cage: stiv.Deformation | None


class ObservedStack:
    """All surfaces that show a mesh, from its controls, (m, 3) world positions.

    Attributes:
        deformation: infeasible where the topology differs from that at the start.
    """

    def __init__(self, frame: Floats, controls: Floats, held: HeldVertices, parts: _Parts) -> None:
        """Take the parts that `read_steps` has read. Only inside `kept_twins`."""
        self._frame, self._start, self._held = frame, controls, held
        self._cages, self._blocks = parts.cages, parts.blocks
        self._observed = stiv.observed(self._blocks.evaluate, self._blocks.jacobian_of(parts.rows))
        self._ends = self._find_ends(parts.places, parts.settings)
        self.deformation = self.deformation_of(None)

    @classmethod
    def read_steps(
        cls, scene: bpy.types.Scene, frame: Floats, controls: Floats, shown: Sequence[ShownStack]
    ) -> Steps[ObservedStack]:
        """Steps that read the stacks of a mesh with a frame, (4, 4). Raise InputError if they cannot be followed."""
        for each in shown:
            check_projections(each.ob, each.evaluation)
        held = find_held_vertices([each.ob for each in shown], to_local(frame, controls))
        with kept_twins():
            settings = [BlockSettings.read(each.ob, scene, each.evaluation) for each in shown]
            keys = [(each.shown_by, id(showing.cage)) for each, showing in zip(settings, shown, strict=True)]
            order = list(dict.fromkeys(keys))
            firsts = [keys.index(key) for key in order]
            cages = [shown[first].cage for first in firsts]
            blocks, turns = [], Turns()
            for first, cage in zip(firsts, cages, strict=True):
                start = controls if cage is None else cage.surface(controls)
                blocks.append((yield from StackBlock.read_steps(settings[first], frame, start, held, turns)))
                yield from turns.take()
            rows = []
            for block in blocks:
                rows.append(block.rows())
                yield from turns.take()
            parts = _Parts(cages, _Blocks(blocks), rows, [order.index(key) for key in keys], settings)
            return cls(frame, controls, held, parts)

    def hold(self, controls: Floats) -> Floats:
        """World positions, (m, 3), with vertices where Mirror and Weld modifiers need them."""
        return self._held.hold(controls, self._start, self._frame)

    @property
    def leaders(self) -> Indices | None:
        """The vertex with which each one moves because a modifier merges them, (m,); None if each moves alone."""
        return self._held.leaders

    @property
    def has_surface(self) -> bool:
        """Had the last evaluation the topology of the start?"""
        return self._blocks.have_surface

    @property
    def followed(self) -> stiv.Weights:
        """The controls that each vertex of the surfaces follows, (n, m), with equal weights."""
        anchors = np.concatenate([block.anchors for block in self._blocks.blocks])
        ends = identity_weights(len(anchors)) if self._ends is None else stiv.linear_weights(self._ends)[0]
        columns = anchors[ends.indices]
        return stiv.Weights(ends.indptr, columns, np.ones(len(columns)), (ends.shape[0], len(self._start)))

    def deformation_of(self, vertices: stiv.Deformation | None) -> stiv.Deformation:
        """The surfaces of controls that move the vertices by a deformation; None: of the vertices themselves."""
        chain: list[stiv.Deformation] = [self._observed]
        if self._cages != [None]:
            count = len(self._start)
            chain.append(stack_deformations([each or identity_deformation(count) for each in self._cages]))
        chain += [] if vertices is None else [vertices]
        return stiv.compose(*chain) if self._ends is None else stiv.compose(self._ends, *chain)

    def renew_jacobian(self) -> None:
        """Measure the Jacobian at the last evaluation, unless it is constant."""
        if not self._blocks.are_exact:
            self._observed.set_jacobian(self._blocks.jacobian())

    def _find_ends(self, places: Sequence[int], settings: Sequence[BlockSettings]) -> stiv.Deformation | None:
        """From the vertices of all blocks to those of all surfaces; None if these are the same."""
        counts = [block.count for block in self._blocks.blocks]
        if list(places) == [*range(len(counts))] and all(each.end.subdivision is None for each in settings):
            return None
        rows = []
        for place, each in zip(places, settings, strict=True):
            block, subdivision = self._blocks.blocks[place], each.end.subdivision
            weights = identity_weights(block.count) if subdivision is None else block.end_weights(subdivision)
            rows.append(moved_columns(weights, sum(counts[:place]), sum(counts)))
        return stiv.linear(stack_weights(rows))


@dataclass(frozen=True)
class _Parts:
    """The stacks of all surfaces, for an `ObservedStack`.

    Attributes:
        cages: of the distinct blocks, as in `ShownStack`.
        blocks: the distinct ones.
        rows: the rows of the Jacobian of each block.
        places: the number of its block for each surface.
        settings: of each surface.
    """

    cages: Sequence[stiv.Deformation | None]
    blocks: _Blocks
    rows: Sequence[Rows]
    places: Sequence[int]
    settings: Sequence[BlockSettings]


@dataclass
class _Blocks:
    """The distinct blocks of all surfaces.

    Apart from `ObservedStack`: the core holds `evaluate`, and a reference back to the core's object would be a cycle.
    """

    blocks: list[StackBlock]
    have_surface: bool = True  #: at the last evaluation

    @property
    def are_exact(self) -> bool:
        """Is the Jacobian constant?"""
        return all(block.exact is not None for block in self.blocks)

    def evaluate(self, positions: Floats) -> Floats | None:
        """World positions of all blocks, (n, 3), from the vertices' positions in each, stacked; None: infeasible."""
        with kept_twins():
            inputs = np.split(positions, len(self.blocks))
            found = [block.evaluate(each) for block, each in zip(self.blocks, inputs, strict=True)]
        feasible = [each for each in found if each is not None]
        self.have_surface = len(feasible) == len(found)
        return np.concatenate(feasible) if self.have_surface else None

    def jacobian(self) -> tuple[Indices, Indices, Floats, tuple[int, int]] | stiv.Weights:
        """The present Jacobian."""
        with kept_twins():
            return self.jacobian_of([block.rows() for block in self.blocks])

    def jacobian_of(self, rows: Sequence[Rows]) -> tuple[Indices, Indices, Floats, tuple[int, int]] | stiv.Weights:
        """The rows of all blocks together; weights if x, y and z act alike in all of them."""
        controls = self.blocks[0].controls
        firsts = np.cumsum([0, *(len(indices) for _, indices, _ in rows)])
        starts = [indptr[:-1] + first for (indptr, _, _), first in zip(rows, firsts, strict=False)]
        indptr = np.append(np.concatenate(starts), firsts[-1]).astype(np.int32)
        indices = np.concatenate([each + place * controls for place, (_, each, _) in enumerate(rows)]).astype(np.int32)
        values = [each for _, _, each in rows]
        shape = len(indptr) - 1, controls * len(self.blocks)
        if all(each.ndim == 1 for each in values):
            return stiv.Weights(indptr, indices, np.concatenate(values), shape)
        frames = [each if each.ndim == 3 else each[:, None, None] * np.eye(3) for each in values]
        return indptr, indices, np.concatenate(frames), shape
