# SPDX-License-Identifier: GPL-3.0-or-later
"""The guard's knowledge of the scene: the accepted state, and its intersections."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import bpy

from .. import stiv_blender
from .correction import Outcome
from .problem import Problem

Pairs = frozenset[tuple[str, str]]


@dataclass
class Record:
    """The accepted scene and its intersections, which the guard leaves alone.

    Attributes:
        accepted: the scene from which the next result is corrected; None before the first test.
        clear: the last state without an uncorrected result, and its frame; None before the first.
        problem: what intersects, and why; None if nothing does.
        seen, uncorrected: pairs of objects that intersected at any time, and those left by an uncorrected result.
    """

    accepted: stiv_blender.AcceptedScene | None = None
    clear: tuple[stiv_blender.SceneState, int] | None = None
    problem: Problem | None = None
    seen: Pairs = frozenset()
    uncorrected: Pairs = frozenset()

    def note_selection(self, context: bpy.types.Context) -> None:
        """Store the selection, which is not a change to guard."""
        if self.accepted is not None:
            self.accepted = self.accepted.with_selection(context)

    def allows(self, pairs: Sequence[stiv_blender.FacePair], restored: bool) -> bool:
        """Whether pairs may intersect: they only touch, cut in the accepted scene, or undo and redo restored them."""
        known = frozenset() if self.accepted is None else _with_joined(self.accepted.known.cutting_objects)
        return objects_of(pairs) <= (self.seen if restored else known)

    def accept(self, context: bpy.types.Context, outcome: Outcome, restored: bool) -> bool:
        """Accept the current scene with its intersections; returns whether the guard left any that are new.

        restored: undo or redo made the scene, so that pairs seen before are not new.
        """
        if outcome.failed:
            self.problem = Problem(reason=outcome.reason)
            return True
        now = objects_of(outcome.pairs)
        before = now if self.accepted is None else _with_joined(self.accepted.known.cutting_objects)
        added = now - before - (self.seen if restored else frozenset())
        self.seen |= now
        self.uncorrected |= added
        self.accepted = stiv_blender.AcceptedScene.read(context, outcome.pairs)
        self.problem = self._problem(outcome)
        if self.problem is None or self.problem.known:
            self.clear = (self.accepted.state, context.scene.frame_current)
        return bool(added)

    def uncorrected_of(self, outcome: Outcome) -> Problem | None:
        """The rest of uncorrected results in an outcome; None if nothing is."""
        if outcome.failed:
            return Problem(reason=outcome.reason)
        left = tuple(pair for pair in outcome.cutting if stiv_blender.object_pair(pair) in self.uncorrected)
        if not left:
            return None
        earlier = self.problem.reason if self.problem is not None and not self.problem.known else ""
        return Problem(left, outcome.reason or earlier)

    def _problem(self, outcome: Outcome) -> Problem | None:
        left = self.uncorrected_of(outcome)
        return left or (Problem(outcome.cutting, known=True) if outcome.cutting else None)


def objects_of(pairs: Sequence[stiv_blender.FacePair]) -> Pairs:
    """The pairs of objects that cut each other in pairs of elements."""
    return stiv_blender.KnownIntersections(pairs).cutting_objects


def _with_joined(known: Pairs) -> Pairs:
    """Known pairs; of a pair whose one object is gone, because it was joined, also the other one with itself."""
    gone = {name for pair in known for name in pair if name not in bpy.data.objects}
    return known | {(name, name) for pair in known if gone & {*pair} for name in pair if name not in gone}
