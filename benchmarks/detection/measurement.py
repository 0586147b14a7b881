# SPDX-License-Identifier: GPL-3.0-or-later
"""Times of one step: our detector in its three states and the peer's parts in turn, the least of the repeats."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from types import ModuleType

import numpy as np

import stiv
from blend_fixtures.scenes.detection_steps import Step
from stiv import _native

from .ipc_toolkit import NARROW_PHASES, Peer

PATIENCE = 3.0  #: a narrow phase this many times slower than the best one so far is not run again


@dataclass
class Figures:
    """What one step took on a number of threads; times in milliseconds, None where a peer is not installed."""

    scene: str
    triangles: int
    threads: int
    vectors: str  #: our vector code, see native/include/stiv/vector_target.hpp
    hits: int
    earliest: float  #: time of the first event, inf if there is none
    build: float  #: a new detector and its first find
    first: float  #: a find of a kept detector from a start that it has not seen: one full detection
    again: float  #: a further find from the same start to a nearer end: the next round of an edit
    candidates: int | None = None  #: pairs of vertex and face or two edges whose swept boxes overlap, by the peer
    peer_broad: float | None = None
    peer_narrow: dict[str, float] = field(default_factory=dict)
    peer_earliest: dict[str, float] = field(default_factory=dict)  #: time found, by narrow phase

    @property
    def peer_best(self) -> tuple[str, float] | None:
        """The peer's quicker narrow phase and the milliseconds of a whole detection with it."""
        if self.peer_broad is None:
            return None
        name = min(self.peer_narrow, key=lambda narrow: self.peer_narrow[narrow])
        return name, self.peer_broad + self.peer_narrow[name]


class Stopwatch:
    """The least time of each thing measured, milliseconds: of the processor for one thread, of the clock for more."""

    def __init__(self, threads: int) -> None:
        self._clock = time.process_time if threads == 1 else time.perf_counter
        self.least: dict[str, float] = {}

    def run(self, name: str, action: Callable[[], object]) -> None:
        """Time one call."""
        start = self._clock()
        action()
        self.least[name] = min(self.least.get(name, np.inf), 1e3 * (self._clock() - start))


def measure(step: Step, threads: int, repeats: int, ipctk: ModuleType | None) -> Figures:
    """Time everything `repeats` times in turn, so that what else the machine does falls on all alike."""
    watch = Stopwatch(threads)
    peer = Peer(ipctk, step, threads) if ipctk else None
    detector = stiv.Detector(step.triangles, threads=threads)
    detector.find(step.start, step.end)
    motion = step.end - step.start
    nearer = step.start + 0.9 * motion
    earliest: dict[str, float] = {}
    for _ in range(repeats):
        watch.run("build", lambda: stiv.Detector(step.triangles, threads=threads).find(step.start, step.end))
        detector.find(step.start - 3 * motion, step.start - 2 * motion)  # an edit before: nothing of this one is known
        watch.run("first", lambda: detector.find(step.start, step.end))
        watch.run("again", lambda: detector.find(step.start, nearer))
        if peer:
            _race(peer, watch, earliest)
    events = detector.find(step.start, step.end)
    least = watch.least
    figures = Figures(
        step.name,
        len(step.triangles),
        threads,
        _native.vector_target().name,
        len(events),
        float(events.time.min(initial=np.inf)),
        least["build"],
        least["first"],
        least["again"],
    )
    if peer:
        figures.candidates, figures.peer_broad = peer.candidate_count, least["broad"]
        figures.peer_narrow = {name: least[name] for name in NARROW_PHASES}
        figures.peer_earliest = earliest
    return figures


def _race(peer: Peer, watch: Stopwatch, earliest: dict[str, float]) -> None:
    watch.run("broad", peer.find_candidates)
    best = min(watch.least.get(name, np.inf) for name in NARROW_PHASES)
    for name in NARROW_PHASES:
        if watch.least.get(name, 0.0) <= PATIENCE * best:
            watch.run(name, partial(_note_earliest, peer, name, earliest))


def _note_earliest(peer: Peer, narrow_phase: str, earliest: dict[str, float]) -> None:
    earliest[narrow_phase] = peer.earliest_time(narrow_phase)
