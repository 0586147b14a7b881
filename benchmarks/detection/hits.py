# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs that really collide in a step: our hits and Tight-Inclusion's, checked in exact arithmetic.

Both report every colliding pair, so the hits confirmed by exact arithmetic are all of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

import numpy as np

import stiv
from blend_fixtures.scenes.detection_steps import Step
from tests.oracles.first_contact import first_contact

from .ipc_toolkit import Peer

Pair = tuple[str, tuple[int, ...]]


@dataclass(frozen=True)
class Hits:
    """Numbers of pairs at separation 0."""

    exact: int  #: collide in exact arithmetic
    ours: int
    ours_false: int  #: our hits that do not collide
    ours_missed: int
    tight_inclusion: int
    tight_inclusion_false: int
    tight_inclusion_missed: int

    def __str__(self) -> str:
        """One line."""
        return (
            f"pairs that meet: {self.exact:,} by exact arithmetic;"
            f" {self.ours:,} reported here ({self.ours_false} do not meet, {self.ours_missed} missed);"
            f" {self.tight_inclusion:,} by Tight-Inclusion"
            f" ({self.tight_inclusion_false} do not meet, {self.tight_inclusion_missed} missed)"
        )


def count_hits(step: Step, ipctk: ModuleType) -> Hits:
    """Run both, and exact arithmetic on every reported pair."""
    events = stiv.Detector(step.triangles, threads=1).find(step.start, step.end)
    ours = {_named(kind, row) for kind, row in zip(events.kind_names, events.vertices.tolist(), strict=True)}
    peer = Peer(ipctk, step, 1)
    peer.find_candidates()
    theirs = {_named(kind, row) for kind, row in peer.hits("tight inclusion")}
    meeting = {pair for pair in ours | theirs if _meet(step, pair)}
    return Hits(
        len(meeting),
        len(ours),
        len(ours - meeting),
        len(meeting - ours),
        len(theirs),
        len(theirs - meeting),
        len(meeting - theirs),
    )


def _named(kind: str, row: list[int]) -> Pair:
    """A canonical key of a pair, for any order of its face and edges."""
    first = 1 if kind == "vf" else 2
    sides = [tuple(sorted(row[:first])), tuple(sorted(row[first:]))]
    return kind, sum(sides if kind == "vf" else sorted(sides), ())


def _meet(step: Step, pair: Pair) -> bool:
    kind, row = pair
    start, end = np.asarray(step.start)[list(row)], np.asarray(step.end)[list(row)]
    return first_contact(kind, start.tolist(), end.tolist()) is not None
