# SPDX-License-Identifier: GPL-3.0-or-later
"""Accepted states written into Blender, and what Blender makes of them read back and tested."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

import stiv
from stiv.blender.controls.control_set import Part
from stiv.blender.edit.results import summed
from stiv.blender.edit.sessions import split, stacked
from stiv.blender.edit.solver import Solving
from stiv.blender.edit.trail import Place, Trail, latest
from stiv.blender.scene.arrays import Floats
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import FacePair, Verification, Verifier

MOST_HALVINGS = 8  # of a step that Blender's evaluation does not pass
MOST_RECUTS = 4  # times that an edit is solved again because Blender cut bent faces otherwise


@dataclass(frozen=True)
class WriteReport:
    """What became of the accepted state in Blender.

    Attributes:
        passed: Blender shows it, or a state on the way to it, free of intersections; False: the one shown before.
        intersections: what met in the state that could not be shown.
        message: why not all of the edit is shown; empty if it is.
        result: of all calls since the last writing, if writing had to solve again; else None.
    """

    passed: bool
    intersections: tuple[FacePair, ...] = ()
    message: str = ""
    result: stiv.EditResult | None = None


class Showing:
    """Shows what was solved. Only states that pass on Blender's own evaluation stay shown."""

    def __init__(self, parts: Sequence[Part], solving: Solving, settings: EditSettings) -> None:
        """For the parts of an edit, as they are, and what solves for them."""
        self._parts = parts
        self._start = stacked([part.controls for part in parts])
        self._solving = solving
        self._settings = settings
        self._verifier = self._new_verifier()

    def show_accepted(self, goal: Floats) -> WriteReport:
        """Write the accepted controls, test what Blender evaluates, and begin a new trail toward the same goal.

        Faces that bent far are cut otherwise by Blender. Where that makes them meet, both cuts take part from then on,
        and the way since the last writing is solved again from where both are free. What still fails is taken back to
        the last state on the way that passes. Raises SceneChangedError when an object is gone or was changed.
        """
        verification = self.show(self._solving.session.controls)
        solved_again = False
        for _ in range(MOST_RECUTS):
            if verification.passed or not self._solving.solve_again(verification.cuts):
                break
            solved_again = True
            verification = self.show(self._solving.session.controls)
        result = summed([leg.result for leg in self._solving.trail.legs]) if solved_again else None
        if not verification.passed:
            return self._fall_back(goal, verification, result)
        self._solving.trail = Trail(self._solving.session.controls, goal)
        return WriteReport(True, result=result)

    def show(self, controls: Floats) -> Verification:
        """Write controls of all parts, (m, 3), whose surface is free, and test what Blender evaluates."""
        self.put(controls)
        return self.verify(self._solving.deformation.surface(controls))

    def verify(self, accepted: Floats) -> Verification:
        """Test what Blender evaluates now, whoever wrote it, against a free surface, (N, 3)."""
        if self._verifier.assembly is not self._solving.assembly:  # more cuts were taken in
            self._verifier = self._new_verifier()
        return self._verifier.verify(bpy.context, accepted)

    def put(self, controls: Floats) -> None:
        """Write controls of all parts, (m, 3), and have Blender evaluate them; nothing is tested."""
        rows = zip(self._parts, split(controls, self._parts), split(self._start, self._parts), strict=True)
        for part, wanted, start in rows:
            if np.array_equal(wanted, start):
                part.writer.restore()
            else:
                part.writer.write(wanted)
        bpy.context.view_layer.update()

    def _new_verifier(self) -> Verifier:
        def is_step_free(start: Floats, end: Floats) -> bool:
            return self._solving.session.is_step_free(start, end)

        return Verifier(self._solving.assembly, is_step_free, self._settings.threads, self._settings.excluded)

    def _fall_back(self, goal: Floats, failure: Verification, result: stiv.EditResult | None) -> WriteReport:
        places = self._solving.trail.places()
        place = latest(places[:-1], lambda each: self.show(each.controls).passed)
        if place is not None and place.leg < 0 and failure.intersections:
            place = self._part_of_step(goal, place, places[1])
        controls = places[0].controls if place is None else place.controls
        self.put(controls)
        self._solving.go_on_from(controls, goal)
        on_the_way = place is not None and place.leg >= 0
        message = f"stopped on the way: {failure.message}" if on_the_way else failure.message
        return WriteReport(on_the_way, failure.intersections, message, result)

    def _part_of_step(self, goal: Floats, start: Place, end: Place) -> Place:
        """A place between two that follow each other which Blender shows free; the first if none is found."""
        for halvings in range(1, MOST_HALVINGS + 1):
            self._solving.go_on_from(start.controls, goal)
            self._solving.session.edit(start.controls + (end.controls - start.controls) / 2**halvings)
            between = self._solving.session.controls
            if not np.array_equal(between, start.controls) and self.show(between).passed:
                return Place(between, end.leg, end.step)
        return start
