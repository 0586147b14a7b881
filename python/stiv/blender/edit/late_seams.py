# SPDX-License-Identifier: GPL-3.0-or-later
"""Begins an edit again where a pose opens a seam that was closed at the start: its two sides then move apart."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import stiv
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.edit.results import is_cut_by_topology
from stiv.blender.edit.sessions import restore_controls
from stiv.blender.edit.snapshot import EditSnapshot
from stiv.blender.edit.solver import EditSolver, start_solver_steps
from stiv.blender.scene.arrays import Floats
from stiv.task import Steps

MOST_TORN = 4  # poses in which seams open, after each of which an edit begins again
ReadApart = Callable[[Sequence[Floats]], Steps[EditSnapshot]]


def start_steps(reading: Steps[EditSnapshot]) -> Steps[tuple[EditSnapshot, EditSolver]]:
    """Steps that read the scene with given ones, and start a solver from there."""
    snapshot = yield from reading
    return snapshot, (yield from start_solver_steps(snapshot))


class LateSeams:
    """The seams of an edit that opened after its start."""

    def __init__(self, read: ReadApart) -> None:
        """read: steps that read the scene again, with seams apart in the given poses, see `Participant.torn`."""
        self._read = read
        self._torn: tuple[Floats, ...] = ()

    def begin_again_steps(
        self, control_sets: Sequence[ControlSet], result: stiv.EditResult
    ) -> Steps[tuple[EditSnapshot, EditSolver] | None]:
        """Steps that restore the scene and start from it with seams apart that opened and thereby stopped the edit.

        They return None, with nothing changed, if no seam did.
        """
        posed = [each.posed for each in control_sets if each.posed is not None]
        opened = [each.opened for each in posed if each.opened is not None]
        if not opened or not is_cut_by_topology(result) or len(self._torn) >= MOST_TORN:
            return None
        torn = (*self._torn, *opened)
        restore_controls(control_sets)
        begun = yield from start_steps(self._read(torn))
        self._torn = torn
        return begun
