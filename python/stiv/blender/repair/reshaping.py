# SPDX-License-Identifier: GPL-3.0-or-later
"""The common basis of contraction, expansion and repair: meshes that change by their cages.

Reading and writing require Blender's main thread; solving does not access Blender.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv import InputError
from stiv.blender.controls.cage import CageWriter
from stiv.blender.controls.cage_surface import HoldingWriter
from stiv.blender.controls.control_reading import make_control_sets
from stiv.blender.controls.control_set import ControlSet, Participant
from stiv.blender.controls.garments import stacked_weights
from stiv.blender.controls.joined_seams import SeamWriter, join_rows
from stiv.blender.controls.participants import merge_participants
from stiv.blender.controls.points import PointGoal, point_weights
from stiv.blender.edit.sessions import (
    assemble_with_controls,
    axes_of_all,
    body_separations,
    deformation_of,
    restore_controls,
    split_controls,
    stack_controls,
    storage_frames,
    write_controls,
)
from stiv.blender.scene.arrays import Floats, Singles, transform_points
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.elements import FacePair
from stiv.blender.scene.evaluations import is_visible
from stiv.blender.scene.guarded_evaluations import read_guarded_scene
from stiv.blender.scene.mesh_reading import read_edges, read_loose_numbers, read_triangles
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.triangulation_flips import FaceTriangles, add_triangles
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import Verification, Verifier

MAX_FLIP_RETRIES = 4  # times that the work is repeated because Blender flipped triangles of bent faces
OUT_OF_TIME_REASONS = {  # by status
    "repaired": "time limit reached; raise it to come closer",
    "budget": "allow more time, or select fewer objects",
}


@dataclass(frozen=True)
class ReshapeReport:
    """The result of a contraction, an expansion or a repair.

    Attributes:
        status: of stiv.RepairResult or stiv.EditResult, or "contracted". "budget": the time limit ended the solve; what
            it had reached is written if `changed`.
        changed: Blender shows a new state; if False, nothing changed.
        message: for the user; may be "".
        pairs: intersections that Blender shows now.
        pairs_before: number of intersections at the start.
        deviation: root mean square distance from the start, in diagonals of the moving surface.
        contracted: the objects that a repair contracted.
        result: merged result of an expansion's edits; None for the others.
        faces_before: number of faces that intersected at the start of a repair that succeeded.
    """

    status: str
    changed: bool
    message: str = ""
    pairs: Sequence[FacePair] = ()
    pairs_before: int = 0
    deviation: float = 0.0
    contracted: str = ""
    result: stiv.EditResult | None = None
    faces_before: int = 0


@dataclass(frozen=True)
class ReshapeSnapshot:
    """The meshes that change, and all obstacles.

    Attributes:
        assembly: all visible meshes as one surface; meshes that do not change are fixed.
        control_sets: the cages, one for each object.
        cage: the meshes of all cages; its vertices are the controls.
        start: controls at the start, (m, 3).
        moves: flags of the controls that may move, (m,): the selected ones in Edit Mode, all in Object Mode; never
            pinned ones.
        settings: separation, roles, threads.
    """

    assembly: Assembly
    control_sets: tuple[ControlSet, ...]
    cage: stiv.Surface
    start: Floats
    moves: NDArray[np.bool_]
    settings: EditSettings

    @cached_property
    def deformation(self) -> stiv.Deformation:
        """From the controls to the surface."""
        return deformation_of(self.assembly, self.control_sets)

    @property
    def frames(self) -> tuple[stiv.StorageFrame, ...]:
        """How the controls are stored."""
        return tuple(storage_frames([(len(each.controls), each.frame) for each in self.control_sets]))

    @property
    def objects(self) -> list[bpy.types.Object]:
        """The objects that change, in the order of the control sets."""
        return [writer.reference.find() for writer in self.writers]

    @property
    def writers(self) -> list[CageWriter]:
        """The writers of all vertices of each cage, in the order of the control sets."""
        return [_cage_writer_of(each) for each in self.control_sets]

    def add_triangles(self, flips: Sequence[FaceTriangles]) -> ReshapeSnapshot:
        """The snapshot with additional triangles of bent faces."""
        return replace(self, assembly=add_triangles(self.assembly, flips))

    def edit_options(self) -> stiv.EditOptions:
        """Options for edits of all controls that may move."""
        max_weights = stacked_weights([each.max_weights for each in self.control_sets])
        return stiv.EditOptions(
            **self.settings.shared(),
            pair_separations=body_separations(self.assembly, self.settings),
            weights=point_weights(self.moves, 1.0, 0.0, max_weights),
            weight_axes=axes_of_all(self.control_sets),
            storage=self.frames,
        )

    def world(self, locals_: Sequence[Singles | None]) -> Floats:
        """Controls, (m, 3), for local positions of each control set; None stands for those at the start."""
        rows = split_controls(self.start, self.control_sets)
        return stack_controls(
            [
                row if local is None else transform_points(_cage_writer_of(each).frame, each.values_at_controls(local))
                for each, local, row in zip(self.control_sets, locals_, rows, strict=True)
            ]
        )

    def deviation(self, controls: Floats) -> float:
        """Root mean square distance of the moving surface from the start, relative to its diagonal."""
        moving = self.assembly.vertices_of([index for each in self.control_sets for index in each.surfaces])
        before = self.deformation.surface(self.start)[moving]
        after = self.deformation.surface(controls)[moving]
        diagonal = float(np.linalg.norm(np.ptp(before, axis=0))) if len(before) else 0.0
        rms = float(np.sqrt(((after - before) ** 2).sum(axis=1).mean())) if len(before) else 0.0
        return rms / diagonal if diagonal > 0 else 0.0

    def show(self, controls: Floats) -> None:
        """Write controls, (m, 3). Raises SceneChangedError if an object was removed or changed."""
        write_controls(self.control_sets, controls, self.start)

    def verify(self, controls: Floats) -> Verification:
        """Write controls whose surface is free of intersections, and test Blender's evaluation."""
        self.show(controls)
        steps = stiv.StepCheck(self.assembly.surface, self.settings.threads)
        verifier = Verifier(self.assembly, steps.is_free, self.settings.threads)
        return verifier.verify(bpy.context, self.deformation.surface(controls))

    def restore(self) -> None:
        """Restore everything exactly."""
        restore_controls(self.control_sets)

    @contextmanager
    def naming_topology_changes(self) -> Iterator[None]:
        """Name the object whose modifiers give a solve no surface of the topology at the start. Raises InputError."""
        try:
            yield
        except stiv.InfeasibleError as error:
            stacks = [(each, each.observed) for each in self.control_sets if each.observed is not None]
            changed = next((each for each, stack in stacks if not stack.has_surface), self.control_sets[0])
            name = _cage_writer_of(changed).reference.name
            raise InputError(f"{name}: its topology changes as it moves; apply its modifiers") from error


def take_reshape_snapshot(
    context: bpy.types.Context, settings: EditSettings, left_out: frozenset[str] = frozenset()
) -> ReshapeSnapshot:
    """Read the selected meshes, in Edit Mode the selected vertices, and all obstacles; changes nothing.

    left_out: names of objects that do not participate. Raises InputError naming object and ways out.
    """
    participants = _participants(context, settings)
    scene, _ = read_guarded_scene(context, settings, lambda name: settings.participates(name) and name not in left_out)
    control_sets, _ = make_control_sets(context, participants, scene.meshes, settings, "move")
    if not control_sets:
        raise InputError("the selection has no surface; select visible meshes")
    assembly = assemble_with_controls(scene.meshes, control_sets, (), settings)
    moves = np.concatenate([_selected(each) for each in control_sets])
    if not moves.any():
        raise InputError("no movable vertex is selected; select some, or leave Edit Mode")
    start = stack_controls([each.controls for each in control_sets])
    return ReshapeSnapshot(assembly, tuple(control_sets), _cage_of(control_sets), start, moves, settings)


def _cage_writer_of(control_set: ControlSet) -> CageWriter:
    writer = control_set.writer
    while isinstance(writer, SeamWriter | HoldingWriter):
        writer = writer.writer
    assert isinstance(writer, CageWriter)
    return writer


def _selected(control_set: ControlSet) -> NDArray[np.bool_]:
    """The controls that may move. Those pinned along any axis are fixed, because contraction acts along all three."""
    rule = control_set.rule
    assert isinstance(rule, PointGoal)
    return rule.selected if rule.pinned is None else rule.selected & ~rule.pinned.points


def _participants(context: bpy.types.Context, settings: EditSettings) -> list[Participant]:
    if context.mode not in ("OBJECT", "EDIT_MESH"):
        mode = context.mode.replace("_", " ").title()
        raise InputError(f"mode {mode} is not supported; use Object Mode")
    visible = [ob for ob in context.view_layer.objects if is_visible(context, ob)]
    chosen = [ob for ob in visible if (ob.mode == "EDIT" if context.mode == "EDIT_MESH" else ob.select_get())]
    participants = []
    for ob in chosen:
        if settings.role(ob.name) in ("obstacle", "ignored") or settings.cage_of(ob.name) != ob.name:
            continue
        if ob.type != "MESH":
            raise InputError(f"{ob.name}: only meshes can be reshaped; convert it to a mesh")
        participants.append(Participant(ObjectReference.of(ob), "cage", True))
    if not participants:
        raise InputError("no movable mesh is selected; select one that is not an obstacle")
    return merge_participants(participants)


def _cage_of(control_sets: Sequence[ControlSet]) -> stiv.Surface:
    """The meshes of all cages, below their modifiers."""
    triangles, loose, first = [np.empty((0, 3), np.int32)], [np.empty((0, 2), np.int32)], 0
    for control_set in control_sets:
        mesh = _cage_writer_of(control_set).reference.find().data
        triangles.append(join_rows(read_triangles(mesh)[0], control_set.control_seams) + first)
        loose.append(join_rows(read_edges(mesh)[read_loose_numbers(mesh)], control_set.control_seams) + first)
        first += len(control_set.controls)
    return stiv.Surface(np.concatenate(triangles), first, np.concatenate(loose))
