# SPDX-License-Identifier: GPL-3.0-or-later
"""What contraction, expansion and repair share: meshes that change by their cages, written and tested as Blender shows.

Reading and writing belong to Blender's main thread; what lies between touches nothing of Blender's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv import InputError
from stiv.blender.controls.cage import CageWriter
from stiv.blender.controls.control_reading import make_parts
from stiv.blender.controls.control_set import Part
from stiv.blender.controls.joined_seams import TiedWriter, joined_rows
from stiv.blender.controls.movers import Mover
from stiv.blender.controls.points import PointGoal, point_weights
from stiv.blender.edit.sessions import (
    axes_of_all,
    deformation_of,
    mobilities,
    pair_separations_of,
    seams_of,
    stacked,
    weights_of_all,
)
from stiv.blender.scene.arrays import Floats, Singles, transform_points
from stiv.blender.scene.assembly import Assembly, assemble
from stiv.blender.scene.evaluated_scene import is_visible
from stiv.blender.scene.guarded_evaluations import read_guarded_scene
from stiv.blender.scene.mesh_reading import read_edges, read_loose_numbers, read_triangles
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.triangulation_flips import Cut, with_cuts
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import FacePair, Verification, Verifier

MOST_RECUTS = 4  # times that work is done again because Blender cut bent faces otherwise


@dataclass(frozen=True)
class ReshapeReport:
    """What became of a contraction, an expansion or a repair in Blender.

    Attributes:
        status: of stiv.RepairResult or stiv.EditResult, or "contracted".
        changed: Blender shows something new; if not, everything is as it was, bit by bit.
        message: what the user should know; empty if there is nothing.
        pairs: what meets in what Blender shows now.
        pairs_before: how many pairs met at the start.
        deviation: root mean square distance from the start, in diagonals of what moved.
        contracted: what a repair contracted.
        result: of an expansion's edits, all together; None of anything else.
    """

    status: str
    changed: bool
    message: str = ""
    pairs: tuple[FacePair, ...] = ()
    pairs_before: int = 0
    deviation: float = 0.0
    contracted: str = ""
    result: stiv.EditResult | None = None


@dataclass(frozen=True)
class Reshaped:
    """The meshes that change and everything in their way.

    Attributes:
        assembly: all visible meshes as one surface; what does not change is fixed.
        parts: the cages, one an object.
        cage: the meshes of all cages side by side, the vertices of which are the controls.
        start: controls at the beginning, (m, 3).
        moves: which of them may move, (m,): the selected ones in Edit Mode, all in Object Mode, without pinned ones.
        settings: separation, roles, threads.
    """

    assembly: Assembly
    parts: tuple[Part, ...]
    cage: stiv.Surface
    start: Floats
    moves: NDArray[np.bool_]
    settings: EditSettings

    @cached_property
    def deformation(self) -> stiv.Deformation:
        """From the controls to the surface."""
        return deformation_of(self.assembly, self.parts)

    @property
    def frames(self) -> tuple[stiv.StorageFrame, ...]:
        """How the controls are stored."""
        firsts = np.cumsum([0, *(len(part.controls) for part in self.parts)])
        return tuple(
            stiv.StorageFrame(int(first), len(part.controls), part.frame)
            for first, part in zip(firsts, self.parts, strict=False)
            if part.frame is not None
        )

    @property
    def objects(self) -> list[bpy.types.Object]:
        """The objects that change, in the order of the parts."""
        return [writer_of(part).reference.find() for part in self.parts]

    def with_cuts(self, cuts: Sequence[Cut]) -> Reshaped:
        """The same with more triangles of faces that bent."""
        return replace(self, assembly=with_cuts(self.assembly, cuts))

    def edit_options(self) -> stiv.EditOptions:
        """How an edit of all controls that may move is solved."""
        given = weights_of_all([part.given for part in self.parts])
        return stiv.EditOptions(
            **self.settings.shared(),
            pair_separations=pair_separations_of(self.assembly, self.settings),
            weights=point_weights(self.moves, 1.0, 0.0, given),
            weight_axes=axes_of_all(self.parts),
            storage=self.frames,
        )

    def world(self, locals_: Sequence[Singles | None]) -> Floats:
        """Controls, (m, 3), of local positions of each part; None: those of the start."""
        rows = np.split(self.start, np.cumsum([len(part.controls) for part in self.parts])[:-1])
        found = []
        for part, local, row in zip(self.parts, locals_, rows, strict=True):
            found.append(row if local is None else transform_points(writer_of(part).frame, part.of_vertices(local)))
        return stacked(found)

    def deviation(self, controls: Floats) -> float:
        """Root mean square distance of the surface from the start, over what may move and in its diagonals."""
        moving = np.concatenate([self.assembly.range_of(index) for part in self.parts for index in part.surfaces])
        before = self.deformation.surface(self.start)[moving]
        after = self.deformation.surface(controls)[moving]
        diagonal = float(np.linalg.norm(np.ptp(before, axis=0))) if len(before) else 0.0
        rms = float(np.sqrt(((after - before) ** 2).sum(axis=1).mean())) if len(before) else 0.0
        return rms / diagonal if diagonal > 0 else 0.0

    def show(self, controls: Floats) -> None:
        """Write controls, (m, 3). Raises SceneChangedError when an object is gone or was changed."""
        ends = np.cumsum([len(part.controls) for part in self.parts])[:-1]
        for part, rows, start in zip(self.parts, np.split(controls, ends), np.split(self.start, ends), strict=True):
            if np.array_equal(rows, start):
                part.writer.restore()
            else:
                part.writer.write(rows)
        bpy.context.view_layer.update()

    def verify(self, controls: Floats) -> Verification:
        """Write controls whose surface is free, and test what Blender makes of them."""
        self.show(controls)
        steps = stiv.StepCheck(self.assembly.surface, self.settings.threads)
        verifier = Verifier(self.assembly, steps.is_free, self.settings.threads)
        return verifier.verify(bpy.context, self.deformation.surface(controls))

    def restore(self) -> None:
        """Put everything back, bit by bit."""
        for part in self.parts:
            part.writer.restore()
        bpy.context.view_layer.update()


def read_reshaped(
    context: bpy.types.Context, settings: EditSettings, left_out: frozenset[str] = frozenset()
) -> Reshaped:
    """The selected meshes, in Edit Mode the selected vertices, and all that is visible; changes nothing.

    left_out: names of objects that nothing is tested against. Raises InputError naming object and ways out.
    """
    movers = _movers(context, settings)
    scene, _ = read_guarded_scene(context, settings, lambda name: settings.takes_part(name) and name not in left_out)
    parts, _ = make_parts(context, movers, scene.meshes, settings, "move")
    if not parts:
        raise InputError("nothing that is selected has a surface; select meshes that are visible")
    count = len(scene.meshes)
    assembly = assemble(
        scene.meshes, mobilities(count, parts), (), settings.ignored_pairs, seams_of(count, parts)
    )  # fmt: skip
    moves = np.concatenate([_selected(part) for part in parts])
    if not moves.any():
        raise InputError("no vertex is selected; select those that may move, or leave Edit Mode")
    start = stacked([part.controls for part in parts])
    return Reshaped(assembly, tuple(parts), _cage_of(parts), start, moves, settings)


def writer_of(part: Part) -> CageWriter:
    """The writer of a cage with all its vertices."""
    writer = part.writer.writer if isinstance(part.writer, TiedWriter) else part.writer
    assert isinstance(writer, CageWriter)
    return writer


def _selected(part: Part) -> NDArray[np.bool_]:
    """Those that may move. What is pinned along any axis stays: shapes contract along all three."""
    rule = part.rule
    assert isinstance(rule, PointGoal)
    return rule.selected if rule.pinned is None else rule.selected & ~rule.pinned.points


def _movers(context: bpy.types.Context, settings: EditSettings) -> list[Mover]:
    if context.mode not in ("OBJECT", "EDIT_MESH"):
        mode = context.mode.replace("_", " ").title()
        raise InputError(f"mode {mode} is not supported; go to Object Mode, or Edit Mode of a mesh")
    visible = [ob for ob in context.view_layer.objects if is_visible(context, ob)]
    chosen = [ob for ob in visible if (ob.mode == "EDIT" if context.mode == "EDIT_MESH" else ob.select_get())]
    movers = []
    for ob in chosen:
        if settings.role(ob.name) in ("obstacle", "ignored") or settings.cage_of(ob.name) != ob.name:
            continue
        if ob.type != "MESH":
            raise InputError(f'object "{ob.name}": only meshes can change shape here; deselect it, or convert it')
        movers.append(Mover(ObjectReference.of(ob), "cage", True))
    if not movers:
        raise InputError("no mesh is selected that may move; select one that is neither obstacle nor ignored")
    return movers


def _cage_of(parts: Sequence[Part]) -> stiv.Surface:
    """The meshes below the modifiers side by side."""
    triangles, loose, first = [np.empty((0, 3), np.int32)], [np.empty((0, 2), np.int32)], 0
    for part in parts:
        mesh = writer_of(part).reference.find().data
        triangles.append(joined_rows(read_triangles(mesh)[0], part.tied) + first)
        loose.append(joined_rows(read_edges(mesh)[read_loose_numbers(mesh)], part.tied) + first)
        first += len(part.controls)
    return stiv.Surface(np.concatenate(triangles), first, np.concatenate(loose))
