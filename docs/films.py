# SPDX-License-Identifier: GPL-3.0-or-later
"""States of the gallery's sessions, solved anew, to be rendered by make_gallery.py."""

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
PARTS_OF_PRESS = 8  # of the face's motion, each gone in one edit from the start
EXPANSIONS, CONTRACTIONS = 16, 24


@dataclass(frozen=True)
class Film:
    """One surface, and in order what is seen side by side at each moment: one state (N, 3) or several."""

    surface: stiv.Surface
    frames: list[tuple[Array, ...]]


def filmed(session: Session) -> Film:
    """Every accepted state of a session; its stages share one surface."""
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
    """The body in the shirt that cuts it, then the session from the contracted body on."""
    film = filmed(dressing.session())
    whole = np.concatenate([shape.vertices for shape in dressing.parts().shapes().values()])
    return Film(film.surface, [(whole,)] * 4 + film.frames)


def weightings() -> Film:
    """The four weightings side by side."""
    films = [filmed(session) for session in weighted_handles.sessions()]
    return Film(films[0].surface, [sum(moment, ()) for moment in zip(*(film.frames for film in films), strict=True)])


def pressed_face() -> Film:
    """More and more of the motion, each time in one edit from the start: by the filter of velocities, and by ours."""
    frames = []
    for part in range(PARTS_OF_PRESS + 1):
        states = compare(part / PARTS_OF_PRESS)[1]
        frames.append((states["filter"], states["ours"]))
    return Film(face_into_waves.stage().surface, frames)


def untangled() -> Film:
    """What repair does: contraction until nothing intersects, then back with interference on."""
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
    """All nine by the name of their picture, in the order of the paper's figures."""
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
