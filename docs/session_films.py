# SPDX-License-Identifier: GPL-3.0-or-later
"""States of the gallery's sessions, computed for make_gallery.py."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import stiv
from benchmarks.velocity_filter import compare
from blend_fixtures.scenes.sessions import dressing, face_into_waves, packing, weighted_handles
from blend_fixtures.scenes.sessions.catalogue import figure_sessions
from blend_fixtures.scenes.sessions.session import Session
from blend_fixtures.scenes.tangled import arm_in_body

Array = NDArray[np.float64]
PARTS_OF_PRESS = 8  # fractions of the face's motion, each in one edit from the start
EXPANSIONS, CONTRACTIONS = 16, 24


@dataclass(frozen=True)
class Film:
    """One surface, and for each moment one or several states (N, 3), shown side by side."""

    surface: stiv.Surface
    frames: list[tuple[Array, ...]]


def filmed(session: Session) -> Film:
    """All accepted states of a session whose stages share one surface."""
    states, stages = [], session.stages()
    stage = next(stages)
    while True:
        solver = stiv.EditSession(stage.surface, stage.deformation, stage.controls, stiv.EditOptions(**stage.options))
        states.append(solver.surface)
        for edit in stage.edits:
            states.append(solver.edit(edit(solver.controls)).surface)
        try:
            stage = stages.send(solver.controls)
        except StopIteration:
            return Film(stage.surface, [(state,) for state in states])


def dressed() -> Film:
    """The body that intersects its shirt, then the session from the contracted body."""
    film = filmed(dressing.session())
    whole = np.concatenate([shape.vertices for shape in dressing.parts().shapes().values()])
    return Film(film.surface, [(whole,)] * 4 + film.frames)


def weightings() -> Film:
    """The four weightings side by side."""
    films = [filmed(session) for session in weighted_handles.sessions()]
    return Film(films[0].surface, [sum(moment, ()) for moment in zip(*(film.frames for film in films), strict=True)])


def pressed_face() -> Film:
    """Increasing fractions of the motion, each in one edit from the start: by the velocity filter, and by our
    method.
    """
    frames = []
    for part in range(PARTS_OF_PRESS + 1):
        states = compare(part / PARTS_OF_PRESS)[1]
        frames.append((states["filter"], states["ours"]))
    return Film(face_into_waves.stage().surface, frames)


def untangled() -> Film:
    """Repair: contraction until nothing intersects, then expansion without intersections."""
    tangle = arm_in_body()
    states, strength = [tangle.positions], 1.0
    while len(stiv.find_intersections(states[-1], tangle.surface)) and len(states) <= CONTRACTIONS:
        states.append(stiv.contraction_step(tangle.surface, states[-1], start=tangle.positions, smoothing=strength))
        strength *= 2
    solver = stiv.EditSession(tangle.surface, stiv.identity(tangle.surface.vertex_count), states[-1])
    contracted = states[-1]
    for number in range(EXPANSIONS):
        share = (number + 1) / EXPANSIONS
        states.append(solver.edit(contracted + share * (tangle.positions - contracted)).surface)
    return Film(tangle.surface, [(state,) for state in states])


def films() -> dict[str, Callable[[], Film]]:
    """All films by the name of their picture, in the order of the paper's figures."""
    sessions = figure_sessions()

    def of(name: str) -> Callable[[], Film]:
        return lambda: filmed(sessions[name])

    return {
        "dressing": dressed,
        "packing": lambda: filmed(packing.session()),
        "untangling": untangled,
        "weighted_handles": weightings,
        "face": pressed_face,
        "plant": of("plant"),
        "hare": of("hare"),
        "tree": of("tree"),
        "knot": of("knot"),
    }
