# SPDX-License-Identifier: GPL-3.0-or-later
"""The session of an edit and the trail of what it accepted; made anew when more cuts of bent faces must stay free."""

from collections.abc import Sequence
from typing import Any

import stiv
from stiv.blender.controls.control_set import Part
from stiv.blender.edit.sessions import deformation_of, make_session
from stiv.blender.edit.trail import Place, Trail, latest
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.triangulation_flips import Cut, with_bent_quads, with_cuts
from stiv.blender.settings import EditSettings


class Solving:
    """Attributes: `assembly` with the cuts that are kept free, `deformation`, and the `trail`."""

    def __init__(self, assembly: Assembly, parts: Sequence[Part], controls: Floats, settings: EditSettings) -> None:
        """Begin at controls of all parts, (m, 3), unless interference is off.

        Raises InputError, StartIntersectsError.
        """
        self._parts = parts
        self._settings = settings
        self._weights = [part.weights for part in parts]
        self._session: stiv.EditSession | None = None
        self._at_start = self.assembly = assembly
        self.deformation = deformation_of(assembly, parts)
        if settings.interference:
            self._at_start = with_bent_quads(assembly, settings.threads)
            self._take(self._at_start, controls)
        self.trail = Trail(controls, controls)

    @property
    def has_begun(self) -> bool:
        """Is there a state that is known to be free?"""
        return self._session is not None

    @property
    def session(self) -> stiv.EditSession:
        """What solves; there is none before interference was on."""
        assert self._session is not None, "interference has been off from the start"
        return self._session

    def solve(self, goal: Floats | None, **execution: Any) -> stiv.EditResult:
        """Drag to a goal, (m, 3), or settle (None)."""
        result = self.session.settle(**execution) if goal is None else self.session.drag(goal, **execution)
        self.trail.add(goal, result)
        return result

    def forget(self) -> None:
        """Have no state any more that is known to be free."""
        self._session = None

    def weigh(self, weights: Sequence[Floats]) -> None:
        """Go on from the accepted state with other response weights, (m,) for each part."""
        self._weights = list(weights)
        if self._session is None:
            return
        accepted, goal = self.session.controls, self.trail.goal_at(self.trail.places()[-1])
        self._take(self.assembly, accepted)
        self.session.restore(accepted, goal)

    def go_on_from(self, controls: Floats, goal: Floats) -> None:
        """Begin a new trail at controls that were accepted before, perhaps before the present cuts were known.

        Raises StartIntersectsError, with nothing changed, for controls that are not free of intersections.
        """
        try:
            if self._session is None:
                self._take(self.assembly, controls)
            self.session.restore(controls, goal)
        except stiv.StartIntersectsError:
            if self._session is None or self.assembly is self._at_start:
                raise
            self._take(self._at_start, controls)
            self.session.restore(controls, goal)
        self.trail = Trail(controls, goal)

    def solve_again(self, cuts: Sequence[Cut]) -> bool:
        """Take in more cuts, go back to where they are free, and solve from there for what the trail was to do.

        False, with nothing done, if there are no cuts, or nothing of the trail is free with them.
        """
        if not cuts:
            return False
        assembly = with_cuts(self.assembly, cuts)

        def is_free(place: Place) -> bool:
            q = self.deformation.surface(place.controls)
            return self._settings.excluded.allow(assembly, q, self._settings.threads)

        place = latest(self.trail.places(), is_free)
        if place is None:
            return False
        goal = self.trail.goal_at(place)
        self._take(assembly, place.controls)
        self.session.restore(place.controls, goal)
        for leg in self.trail.cut_at(place):
            self.solve(leg.goal)
        return True

    def _take(self, assembly: Assembly, controls: Floats) -> None:
        deformation = deformation_of(assembly, self._parts)
        self._session = make_session(assembly, deformation, self._parts, controls, self._weights, self._settings)
        self.deformation, self.assembly = deformation, assembly
