# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages about the objects of an edit: what it found at its start, and what its present state leaves to the user."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import stiv
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.joint_folds import fold_note
from stiv.blender.controls.placement_writer import PlacementWriter
from stiv.blender.edit.motion_goal import MotionGoal
from stiv.blender.edit.solver import EditSolver
from stiv.blender.edit.standstill import contact_text, lock_text
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.exclusions import intersection_notes
from stiv.blender.scene.torn_seams import torn_seam_note


@dataclass(frozen=True)
class EditNotes:
    """Notes on the state of a solver, "" where there is nothing to say. Those on faces need a session.

    Attributes:
        solver: of the edit.
        dropped_exclusions: message about excluded pairs that are stale; "" if there are none.
        threads: number of threads that search; 0 uses all cores.
    """

    solver: EditSolver
    dropped_exclusions: str
    threads: int

    @property
    def start_notes(self) -> tuple[str, ...]:
        """Notes about stale exclusions, intersections at the start, untested loose parts, seams, and shared meshes."""
        dropped = (self.dropped_exclusions,) if self.dropped_exclusions else ()
        notes = tuple(note for each in self._sets for note in (each.note, each.passenger_note) if note)
        moving = {name for each in self._sets for name in each.names}
        intersecting = intersection_notes(self.solver.intersecting, moving, self.solver.excluded)
        return (*dropped, *intersecting, *self.solver.loose_part_notes, *notes)

    @property
    def passenger_note(self) -> str:
        """The message on selected objects without a surface that cannot move along."""
        return next((each.passenger_note for each in self._sets), "")

    @property
    def fold_note(self) -> str:
        """The message on faces at joints that cut into each other in the accepted state, and did not at the start."""
        assembly, posed = self.solver.assembly, [each.posed for each in self._sets if each.posed is not None]
        notes = (
            fold_note(assembly, each.surfaces, each.untested, self.solver.session.surface, self.threads)
            for each in posed
        )
        return next(filter(None, notes), "")

    @property
    def torn_seam_note(self) -> str:
        """The message on faces at seams that the edit has torn, if they cut each other in the accepted state."""
        solver = self.solver
        if not len(solver.excluded):
            return ""
        return torn_seam_note(solver.assembly, solver.excluded, solver.session.surface, self.threads)

    @property
    def reset_note(self) -> str:
        """The message on a placed object that its keyframes reset at the next frame."""
        writers = [each.writer for each in self._sets if isinstance(each.writer, PlacementWriter)]
        keyed = [name for writer in writers for name in writer.changed_with_keyframes()]
        return f"{keyed[0]}: the next frame resets it to its keyframes; key it" if keyed else ""

    def standstill_note(self, result: stiv.EditResult, moving: frozenset[str], start: Floats, goal: MotionGoal) -> str:
        """Why nothing has moved, from the last result; "" if something has, nothing was to move, or it is not known.

        moving: names of the objects that follow the goal. start: of the controls, (m, 3).
        """
        wanted = goal.controls - start
        if wanted.any():
            made = self.solver.session.controls - start
            return contact_text(result, self.solver.assembly, moving, (made, wanted))
        asked = goal.motion is not None and not np.array_equal(goal.motion.matrix, np.eye(4))
        return lock_text(self._sets) if asked else ""

    @property
    def _sets(self) -> Sequence[ControlSet]:
        return self.solver.control_sets
