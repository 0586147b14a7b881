# SPDX-License-Identifier: GPL-3.0-or-later
"""The surface of all visible objects as a function of sliders and clothes that yield, evaluated in the scene itself."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import bpy
import numpy as np

from stiv.blender.controls.closed_seams import MergedRows, limit_to_closed
from stiv.blender.controls.garments import Blocks, Garment, make_garments, rows_of_blocks
from stiv.blender.controls.participants import find_clothes
from stiv.blender.morphing.key_sliders import KeySlider
from stiv.blender.scene.arrays import Floats, Indices, diagonal_of
from stiv.blender.scene.assembly import assemble, mesh_seams
from stiv.blender.scene.guarded_evaluations import read_guarded_scene
from stiv.blender.scene.loose_parts import find_touching_parts, loose_part_notes, without_loose_parts
from stiv.blender.scene.references import SceneChangedError
from stiv.blender.scene.triangulation_flips import guard_bent_quads
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import read_shown
from stiv.scalars import difference_jacobian_steps
from stiv.seams import Seams
from stiv.task import Steps

DIFFERENCE = 0.05  # of the range of a slider, for a Jacobian
OWN_SLIDER = 1.0  # range of a slider without a range
CLOTHES_STEP = 0.01  # of controls of clothes, in sizes, that shows which seams they open


class MorphedScene:
    """The surface as a function of controls, (m, 3): rows (value, 0, 0) of sliders, then the controls of clothes.

    Methods whose name ends with ``_steps`` write other controls between their steps, and do not mind any that the
    caller writes there.

    Attributes:
        assembly: objects that no control moves are fixed. Seams of the others that stay closed are merged.
        garments: clothes that yield, by the settings.
        start: the controls at the start, (m, 3).
        written: the controls that Blender shows, (m, 3).
        tested: the last ones whose evaluation passed the test, (m, 3).
        rows: numbers of the vertices of the assembly among those of all meshes, (N,).
        lower, upper: limits of the sliders, (k,).
        size: diagonal of the surface that controls move.
    """

    def __init__(self, context: bpy.types.Context, settings: EditSettings, sliders: Sequence[KeySlider]) -> None:
        """Read the scene. Raises InputError."""
        self._context, self._sliders, self.settings = context, sliders, settings
        self.lower, self.upper = (np.array(ends) for ends in zip(*((s.lower, s.upper) for s in sliders), strict=True))
        scene, _ = read_guarded_scene(context, settings)
        clothes = [each for each in find_clothes(context, settings) if each.reference.name not in self.owners]
        self.garments: tuple[Garment, ...] = tuple(make_garments(context, clothes, scene.meshes, settings))
        values = np.array([[each.start, 0.0, 0.0] for each in sliders])
        self.start = self.written = self.tested = np.concatenate(
            [values, *(each.controls.controls for each in self.garments)]
        )
        self._whole = assemble(scene.meshes, ["deformable"] * len(scene.meshes), (), settings.ignored_pairs)
        self.assembly, self._rest = self._whole, self._whole.positions
        self._fixed = np.zeros(len(self._rest), bool)
        self._vertices = self._merge([None] * len(scene.meshes))
        self.size = 1.0

    @property
    def count(self) -> int:
        """Number of sliders."""
        return len(self._sliders)

    @property
    def owners(self) -> set[str]:
        """Names of the objects that have the sliders."""
        return {each.owner.name for each in self._sliders}

    @property
    def rows(self) -> Indices:
        """See the class."""
        return self._vertices.rows

    def write(self, controls: Floats) -> None:
        """Write controls, (m, 3), and update Blender's evaluation."""
        for slider, (value, *_), (before, *_) in zip(self._sliders, controls, self.written, strict=False):
            if value != before:
                slider.write(float(value))
        for garment, own in zip(self.garments, self._parts(), strict=True):
            if np.array_equal(controls[own], self.start[own]):
                garment.controls.writer.restore()
            elif not np.array_equal(controls[own], self.written[own]):
                garment.controls.writer.write(controls[own])
        self.written = controls
        self._context.view_layer.update()

    def write_tested(self) -> None:
        """Write the tested controls, unless Blender shows them."""
        if self.written is not self.tested:
            self.write(self.tested)

    def restore(self) -> None:
        """Write the controls of the start."""
        self.write(self.start)

    def evaluate(self, controls: Floats) -> Floats | None:
        """The surface, (N, 3); None if its topology, or something that no control moves, changes, or a seam opens."""
        whole = self._evaluate_whole(controls)
        return None if whole is None else self._vertices.merged(whole)

    def evaluate_values(self, values: Floats) -> Floats | None:
        """The surface at values of the sliders, (k,), with the clothes as they are."""
        return self.evaluate(self.with_values(self.written, values))

    def with_values(self, controls: Floats, values: Floats) -> Floats:
        """The controls with other values, (k,)."""
        found = controls.copy()
        found[: self.count, 0] = values
        return found

    def shows(self, controls: Floats) -> bool:
        """Are the sliders at these controls, and all that controls do not move as at the start?"""
        try:
            present = np.array([slider.read_value() for slider in self._sliders])
        except SceneChangedError:
            return False
        same = np.array_equal(present, controls[: self.count, 0].astype(np.float32))
        return same and self.evaluate(controls) is not None

    def jacobian_steps(self, at: Floats) -> Steps[Floats]:
        """Steps to the derivative of the surface by the sliders at controls, (N, 3, k), written in the end."""
        found = yield from difference_jacobian_steps(
            lambda values: self.evaluate(self.with_values(at, values)),
            at[: self.count, 0],
            DIFFERENCE * self._ranges,
            lower=self.lower,
            upper=self.upper,
        )
        self.write(at)
        return found

    def blocks_steps(self, jacobian: Floats, at: Floats) -> Steps[tuple[Indices, Indices, Floats, tuple[int, int]]]:
        """Steps to the derivative by all controls, as blocks, at some. jacobian: that by the sliders."""
        row, slider = (each.astype(np.int32) for each in np.nonzero((jacobian != 0).any(axis=1)))
        found = [Blocks(self.rows[row], slider, jacobian[row, :, slider][:, :, None] * np.array([1.0, 0, 0]))]
        for garment, own in zip(self.garments, self._parts(), strict=True):

            def evaluate(controls: Floats, own: slice = own) -> Floats | None:
                moved = at.copy()
                moved[own] = controls
                return self._evaluate_whole(moved)

            made = yield from garment.blocks_steps(evaluate, at[own], self._rows_of(garment))
            found.append(Blocks(made.rows, made.controls + own.start, made.data))
        self.write(at)
        indptr, columns, data = rows_of_blocks(found, len(self._rest), self.rows)
        return indptr, columns, data, (len(jacobian), len(at))

    def simplify_steps(self, goals: Sequence[Floats], jacobian: Floats) -> Steps[Floats]:
        """Steps that fix the objects that no clothes and neither the Jacobian nor any of the goals, (k,), move.

        They merge the seams of all others that stay closed there. jacobian: of the start, of all meshes, (n, 3, k);
        they return that of the assembly.
        """
        moved = (jacobian != 0).any(axis=(1, 2))
        for garment in self.garments:
            moved[self._rows_of(garment)] = True
        at_goals: list[Floats] = []
        for goal in goals:
            found = self._evaluate_whole(self.with_values(self.start, goal))
            yield None
            if found is not None:
                at_goals.append(found)
                moved |= (found != self._rest).any(axis=1)
        moves = [bool(moved[a:b].any()) for a, b in pairwise(self._whole.starts)]
        mobility = ["deformable" if each else "fixed" for each in moves]
        meshes, ignored = self._whole.meshes, self.settings.ignored_pairs
        self._fixed = ~np.repeat(moves, np.diff(self._whole.starts))
        self.size = diagonal_of(self._rest[~self._fixed]) or 1.0
        seams = self._closed_seams(moves, [jacobian * self._ranges, *at_goals])
        self.write(self.start)
        yield None
        self.assembly = guard_bent_quads(assemble(meshes, mobility, (), ignored, seams), self.settings.threads)
        self._vertices = self._merge(seams)
        return np.asarray(jacobian[self.rows])

    def leave_out_touching_parts(self) -> tuple[str, ...]:
        """Leave out the loose edges and vertices that touch their own object; returns notes on them."""
        loose = find_touching_parts(self.assembly, (), self.settings.threads)
        notes = loose_part_notes(self.assembly, loose)
        self.assembly = without_loose_parts(self.assembly, loose)
        return notes

    def longest_motion(self, jacobian: Floats, change: Floats) -> float:
        """The longest motion of a vertex by a change of the values, (k,), in sizes of the moving surface."""
        shift = np.einsum("nak,k->na", jacobian[~self._fixed[self.rows]], change)
        return float(np.linalg.norm(shift, axis=1).max(initial=0.0)) / self.size

    def _parts(self) -> list[slice]:
        """Where the controls of each garment are."""
        ends = self.count + np.cumsum([0, *(len(each.controls.controls) for each in self.garments)])
        return [slice(int(first), int(last)) for first, last in pairwise(ends)]

    @property
    def _ranges(self) -> Floats:
        """Ranges of the sliders, (k,), at most `OWN_SLIDER`."""
        ranges = np.where(self.upper > self.lower, self.upper - self.lower, OWN_SLIDER)
        return np.asarray(np.minimum(ranges, OWN_SLIDER), np.float64)

    def _evaluate_whole(self, controls: Floats) -> Floats | None:
        """All meshes, (n, 3); None if their topology, or something that no control moves, changes."""
        self.write(controls)
        try:
            positions = read_shown(self._context, self._whole)
        except SceneChangedError:
            return None
        return positions if np.array_equal(positions[self._fixed], self._rest[self._fixed]) else None

    def _closed_seams(self, moves: Sequence[bool], states: list[Floats]) -> list[Seams | None]:
        """The seams of the meshes that move and stay closed in states, (n, ...), and as the clothes move."""
        meshes, ends = self._whole.meshes, self._whole.starts[1:-1]
        seams = [mesh_seams(mesh.local, mesh.triangles) if m else None for mesh, m in zip(meshes, moves, strict=True)]
        if all(each is None for each in seams):
            return seams
        random = np.random.default_rng(0).uniform(-1, 1, self.start.shape) * self.size * CLOTHES_STEP
        random[: self.count] = 0
        dressed = self._evaluate_whole(self.start + random) if self.garments else None
        states = states if dressed is None else [*states, dressed]
        own = zip(*(np.split(each, ends) for each in states), strict=True)
        return [limit_to_closed(*each) for each in zip(seams, meshes, own, strict=True)]

    def _merge(self, seams: Sequence[Seams | None]) -> MergedRows:
        places = [np.arange(a, b, dtype=np.int32) for a, b in pairwise(self._whole.starts)]
        return MergedRows.of(places, seams, self._rest)

    def _rows_of(self, garment: Garment) -> Indices:
        starts = self._whole.starts
        rows = [np.arange(starts[k], starts[k + 1], dtype=np.int32) for k in garment.controls.surfaces]
        return np.concatenate(rows)
