# SPDX-License-Identifier: GPL-3.0-or-later
"""Resolves an animation: each frame's pose is the goal, and what was accepted for the frame before is the start."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import stiv
from stiv.blender.animation.controls import MovingPart, make_moving_parts
from stiv.blender.animation.tracks import Track, check_movable
from stiv.blender.edit.sessions import meets_only_rendered
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import Assembly, assemble
from stiv.seams import Seams


@dataclass(frozen=True)
class Key:
    """Accepted controls of all parts at a frame, whole or, on the way from one to the next, fractional."""

    frame: float
    controls: Floats


@dataclass(frozen=True)
class Resolved:
    """A resolved animation: between two keys, surfaces that move on straight lines meet nothing, in either direction.

    `frames` tells of each frame, ready for JSON.
    """

    parts: tuple[MovingPart, ...]
    keys: tuple[Key, ...]
    frames: tuple[dict[str, Any], ...]


def resolve(
    tracks: Sequence[Track],
    frames: Sequence[float],
    hold: Collection[str] = (),
    separation: float = 0.0,
    threads: int = 0,
    on_frame: Callable[[str], None] = lambda status: None,
) -> Resolved:
    """Solve frame after frame. hold: names of objects that keep to their animation exactly, and do not give way.

    Raises InputError, and StartIntersectsError where the first frame is not free.
    """
    check_movable(tracks, hold)
    parts = make_moving_parts(tracks, hold)
    told = [_told(frames[0], "start", 0, 0.0, (), 0, True)]
    if not parts:
        return Resolved((), (Key(frames[0], np.empty((0, 3))),), (told[0],))
    solver = _Solver(tracks, parts, separation, threads)
    keys = [Key(frames[0], solver.session.controls)]
    on_frame("start")
    for place in range(1, len(frames)):
        added, status = solver.solve(place, frames[place - 1], frames[place])
        keys += added
        told.append(status)
        on_frame(status["status"])
    return Resolved(tuple(parts), tuple(keys), tuple(told))


class _Solver:
    """The session over all parts, and the goal of the frame before."""

    def __init__(self, tracks: Sequence[Track], parts: Sequence[MovingPart], separation: float, threads: int) -> None:
        self._tracks, self._parts = tracks, parts
        self._goal = np.concatenate([part.controls for part in parts])
        assembly = _assembly(tracks, parts)
        self.deformation = stiv.concatenate(
            [(p.deformation, _vertices(assembly, p)) for p in parts], assembly.positions
        )
        self.session = _session(assembly, self.deformation, self._goal, self._options(separation, threads))
        self._steps = stiv.StepCheck(assembly.surface, threads)

    def solve(self, place: int, before: float, frame: float) -> tuple[list[Key], dict[str, Any]]:
        """The keys from the frame before to this one, and what to tell of it."""
        start = self.session.controls
        last = np.split(self._goal, np.cumsum([len(part.controls) for part in self._parts])[:-1])
        goals = [part.goal(self._tracks, place, old) for part, old in zip(self._parts, last, strict=True)]
        self._goal = np.concatenate(goals)
        results = self._best(start, np.concatenate(last))
        states = self._states(start, [state for result in results for state in result.path])
        times = [before + (frame - before) * (k + 1) / len(states) for k in range(len(states))]
        times[-1] = frame
        keys = [Key(time, state) for time, state in zip(times, states, strict=True)]
        surface, wanted = (self.deformation.surface(controls) for controls in (states[-1], self._goal))
        away = float(np.linalg.norm(surface - wanted, axis=1).max(initial=0.0))
        back = self._free_backward([start, *states])
        rounds = sum(result.rounds for result in results)
        return keys, _told(frame, results[0].status, rounds, away, results[0].blocking, len(states) - 1, back)

    def _best(self, start: Floats, last: Floats) -> list[stiv.EditResult]:
        """Straight to the goal if that is free; else the nearer of that edit and of a drag along with the animation.

        A drag begins with the increment of the animation, which follows a wall that the goal lies behind; where the
        animation comes back out from behind it, that leads away from the goal.
        """
        edits = [self.session.edit(self._goal)]
        if edits[0].status in ("reached", "unchanged"):
            return edits
        self.session.restore(start, last)
        drags = [self.session.drag(self._goal), self.session.settle()]
        if edits[0].energy < drags[-1].energy:
            self.session.restore(edits[0].controls, self._goal)
            return [edits[0]]
        return drags

    def _states(self, start: Floats, path: list[Floats]) -> list[Floats]:
        """What to write: the last state alone if the straight way there and back is free, else all on the way."""
        end = self.session.controls
        if np.array_equal(start, end) or not path:
            return [end]
        first, last = self.deformation.surface(start), self.deformation.surface(end)
        if self._steps.is_free(first, last) and self._steps.is_free(last, first):
            return [end]
        return path if np.array_equal(path[-1], end) else [*path, end]

    def _free_backward(self, states: list[Floats]) -> bool:
        """Is the way free in the other direction of time too, by a test of its own?"""
        surfaces = [self.deformation.surface(state) for state in states]
        steps = zip(surfaces[1:], surfaces[:-1], strict=True)
        return all(np.array_equal(one, other) or self._steps.is_free(one, other) for one, other in steps)

    def _options(self, separation: float, threads: int) -> stiv.EditOptions:
        frames, first = [], 0
        for part in self._parts:
            if part.frame is not None:
                frames.append(stiv.StorageFrame(first, len(part.controls), part.frame))
            first += len(part.controls)
        weights = np.concatenate([np.full(len(part.controls), part.weight) for part in self._parts])
        return stiv.EditOptions(
            separation=separation, weights=weights, single_precision=bool(frames), storage=frames, threads=threads
        )


def _session(
    assembly: Assembly, deformation: stiv.Deformation, controls: Floats, options: stiv.EditOptions
) -> stiv.EditSession:
    try:
        return stiv.EditSession(assembly.surface, deformation, controls, options)
    except stiv.StartIntersectsError as error:
        if meets_only_rendered(assembly, error):
            error.add_note("it does so only when rendered; --guard viewport leaves the render out")
        raise


def _assembly(tracks: Sequence[Track], parts: Sequence[MovingPart]) -> Assembly:
    kinds = {"still": "fixed", "rigid": "rigid", "shape": "deformable"}
    together = [frozenset(tracks[index].mesh.owner.name for index in part.tracks) for part in parts]
    seams: list[Seams | None] = [None] * len(tracks)
    for part in parts:
        seams[part.tracks[0]] = part.tied
    meshes = [track.mesh for track in tracks]
    return assemble(meshes, [kinds[track.kind] for track in tracks], together, seams=seams)


def _vertices(assembly: Assembly, part: MovingPart) -> Any:
    return np.concatenate([assembly.range_of(index) for index in part.tracks])


def _told(
    frame: float, status: str, rounds: int, away: float, blocking: Sequence[str], subframes: int, back: bool
) -> dict[str, Any]:
    return {
        "frame": frame,
        "status": status,
        "rounds": rounds,
        "distance": away,
        "blocking": list(blocking),
        "subframes": subframes,
        "reversible": back,
    }
