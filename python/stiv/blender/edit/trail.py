# SPDX-License-Identifier: GPL-3.0-or-later
"""What a session was asked and what it accepted since its state was last shown."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import stiv
from stiv.blender.scene.arrays import Floats


@dataclass(frozen=True)
class Leg:
    """One call of a session: a drag to a goal, or a settling (None), and what came of it."""

    goal: Floats | None
    result: stiv.EditResult
    path: tuple[Floats, ...]
    """Controls accepted on the way: all of the result's, or the first of them."""


@dataclass(frozen=True)
class Place:
    """Controls accepted on a trail: leg -1 is the state shown, and `step` counts within a leg."""

    controls: Floats
    leg: int
    step: int


@dataclass
class Trail:
    """From the state shown last, and the goal that it was dragged to, to the present one."""

    shown: Floats
    goal: Floats
    legs: list[Leg] = field(default_factory=list)

    def add(self, goal: Floats | None, result: stiv.EditResult) -> None:
        """Another call."""
        self.legs.append(Leg(goal, result, tuple(result.path)))

    def places(self) -> list[Place]:
        """All accepted controls, oldest first; two that follow each other are joined by a free linear step."""
        return [Place(self.shown, -1, 0)] + [
            Place(controls, number, step)
            for number, leg in enumerate(self.legs)
            for step, controls in enumerate(leg.path)
        ]

    def goal_at(self, place: Place) -> Floats:
        """The goal dragged to last when the controls were accepted."""
        goals = [leg.goal for leg in self.legs[: place.leg + 1] if leg.goal is not None]
        return goals[-1] if goals else self.goal

    def cut_at(self, place: Place) -> list[Leg]:
        """End the trail at a place; returns the legs that are left to go, the one cut among them."""
        if place.leg < 0:
            left, self.legs = self.legs, []
            return left
        left = self.legs[place.leg :]
        self.legs = [*self.legs[: place.leg], Leg(left[0].goal, left[0].result, left[0].path[: place.step + 1])]
        return left


def latest(places: Sequence[Place], holds: Callable[[Place], bool]) -> Place | None:
    """The last place at which something holds that held at the beginning, found by looking at few of them.

    Looks back in growing strides, then halves the last of them. What comes out holds; a later one may too. None: it
    holds nowhere that was looked at.
    """
    failed, stride = len(places), 1
    while failed > 0:
        index = max(0, failed - stride)
        if holds(places[index]):
            return _between(places, index, failed, holds)
        failed, stride = index, 2 * stride
    return None


def _between(places: Sequence[Place], held: int, failed: int, holds: Callable[[Place], bool]) -> Place:
    while failed - held > 1:
        middle = (held + failed) // 2
        if holds(places[middle]):
            held = middle
        else:
            failed = middle
    return places[held]
