# SPDX-License-Identifier: GPL-3.0-or-later
"""Times of one step: our detector in its three states and the parts of the peer, the minimum over repeats."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from types import ModuleType

import numpy as np

import stiv
from benchmarks.sessions.peer_mesh import LinearStep, settings_of
from blend_fixtures.scenes.detection_steps import Step
from stiv import _native

from .ipc_toolkit import NARROW_PHASES, Peer

PATIENCE = 3.0  #: a narrow phase this many times slower than the best one so far is not run again


@dataclass
class PeerFigures:
    """Times of the peer for one step in one of its settings, in milliseconds."""

    mesh: float  #: culling, and creating its mesh: once per drag
    broad: float
    narrow: dict[str, float]
    earliest: dict[str, float]  #: time found, by narrow phase
    candidates: int  #: vertex-face and edge-edge pairs whose swept boxes overlap

    @property
    def best(self) -> tuple[str, float]:
        """The faster narrow phase and the milliseconds of a whole detection with it, without creating the mesh."""
        name = min(self.narrow, key=lambda narrow: self.narrow[narrow])
        return name, self.broad + self.narrow[name]


@dataclass
class Figures:
    """Times of one step on a number of threads, in milliseconds; None if a peer is not installed."""

    scene: str
    triangles: int
    threads: int
    vectors: str  #: our vector code, see native/include/stiv/vector_target.hpp
    hits: int
    earliest: float  #: time of the first event, inf if there is none
    build: float  #: a new detector and its first search
    first: float  #: a search of an existing detector from a new start: one full detection
    again: float  #: a further search from the same start to a closer end: the next round of an edit
    peer: dict[str, PeerFigures] = field(default_factory=dict)  #: by its settings; empty if it is not installed

    @property
    def peer_best(self) -> tuple[str, float]:
        """The peer's fastest setting and the milliseconds of a whole detection with it."""
        setting = min(self.peer, key=lambda name: self.peer[name].best[1])
        return setting, self.peer[setting].best[1]


class Stopwatch:
    """The minimum time of each measurement in milliseconds: processor time for one thread, wall time for more."""

    def __init__(self, threads: int) -> None:
        self._clock = time.process_time if threads == 1 else time.perf_counter
        self.least: dict[str, float] = {}

    def run(self, name: str, action: Callable[[], object]) -> None:
        """Time one call."""
        start = self._clock()
        action()
        self.least[name] = min(self.least.get(name, np.inf), 1e3 * (self._clock() - start))


def measure(step: Step, threads: int, repeats: int, ipctk: ModuleType | None) -> Figures:
    """Time everything `repeats` times alternately, so that other load affects all measurements equally."""
    watch = Stopwatch(threads)
    settings = settings_of(LinearStep(step.triangles, step.start, step.end)) if ipctk else ()
    peers = {setting: Peer(ipctk, step, threads, setting) for setting in settings} if ipctk else {}
    detector = stiv.Detector(step.triangles, threads=threads)
    detector.find(step.start, step.end)
    motion = step.end - step.start
    nearer = step.start + 0.9 * motion
    earliest: dict[str, dict[str, float]] = {setting: {} for setting in peers}
    for _ in range(repeats):
        watch.run("build", lambda: stiv.Detector(step.triangles, threads=threads).find(step.start, step.end))
        detector.find(
            step.start - 3 * motion, step.start - 2 * motion
        )  # a previous edit: nothing of this one is cached
        watch.run("first", lambda: detector.find(step.start, step.end))
        watch.run("again", lambda: detector.find(step.start, nearer))
        for setting, peer in peers.items():
            _race(setting, peer, watch, earliest[setting])
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
    for setting, peer in peers.items():
        figures.peer[setting] = PeerFigures(
            least[f"{setting} mesh"],
            least[f"{setting} broad"],
            {name: least[f"{setting} {name}"] for name in NARROW_PHASES},
            earliest[setting],
            peer.candidate_count,
        )
    return figures


def _race(setting: str, peer: Peer, watch: Stopwatch, earliest: dict[str, float]) -> None:
    watch.run(f"{setting} mesh", peer.build_mesh)
    watch.run(f"{setting} broad", peer.find_candidates)
    best = min(watch.least.get(f"{setting} {name}", np.inf) for name in NARROW_PHASES)
    for name in NARROW_PHASES:
        if watch.least.get(f"{setting} {name}", 0.0) <= PATIENCE * best:
            watch.run(f"{setting} {name}", partial(_note_earliest, peer, name, earliest))


def _note_earliest(peer: Peer, narrow_phase: str, earliest: dict[str, float]) -> None:
    earliest[narrow_phase] = peer.earliest_time(narrow_phase)
