# SPDX-License-Identifier: GPL-3.0-or-later
"""Resolves an animation: each frame's pose is a goal, and the accepted state of the frame before is the start."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

import stiv
from stiv.blender.animation.controls import MovingSet, make_moving_sets
from stiv.blender.animation.tracks import Track, check_movable
from stiv.blender.edit.sessions import intersects_only_in_render, storage_frames
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import Assembly, assemble, mesh_seams
from stiv.seams import Seams

REPORT_FIELDS = ("frame", "status", "rounds", "distance", "blocking", "subframes", "reversible")


@dataclass(frozen=True)
class Key:
    """Accepted controls at a frame; additional states between two frames have fractional ones."""

    frame: float
    controls: Floats


@dataclass(frozen=True)
class Resolved:
    """A resolved animation: linear motion between two keys is free of intersections in both directions.

    `frames` describes each frame for JSON.
    """

    moving_sets: tuple[MovingSet, ...]
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
    """Solve one frame after the other. hold: names of objects that follow their animation exactly and do not yield.

    Raises InputError, and StartIntersectsError if the first frame intersects.
    """
    check_movable(tracks, hold)
    moving_sets = make_moving_sets(tracks, hold)
    reports = [_report(frames[0], "start", 0, 0.0, [], 0, True)]
    if not moving_sets:
        return Resolved((), (Key(frames[0], np.empty((0, 3))),), (reports[0],))
    solver = _Solver(tracks, moving_sets, separation, threads)
    keys = [Key(frames[0], solver.session.controls)]
    on_frame("start")
    for place in range(1, len(frames)):
        added, status = solver.solve(place, frames[place - 1], frames[place])
        keys += added
        reports.append(status)
        on_frame(status["status"])
    return Resolved(tuple(moving_sets), tuple(keys), tuple(reports))


class _Solver:
    """The session of all moving sets, and the goal of the frame before."""

    def __init__(
        self, tracks: Sequence[Track], moving_sets: Sequence[MovingSet], separation: float, threads: int
    ) -> None:
        self._tracks, self._moving_sets = tracks, moving_sets
        self._goal = np.concatenate([each.controls for each in moving_sets])
        assembly = _assembly(tracks, moving_sets)
        self.deformation = stiv.concatenate(
            [(p.deformation, assembly.vertices_of(p.tracks)) for p in moving_sets], assembly.positions
        )
        self.session = _session(assembly, self.deformation, self._goal, self._options(separation, threads))
        self._steps = stiv.StepCheck(assembly.surface, threads)

    def solve(self, place: int, before: float, frame: float) -> tuple[list[Key], dict[str, Any]]:
        """The keys from the frame before to this one, and the description of this frame."""
        start = self.session.controls
        last = np.split(self._goal, np.cumsum([len(each.controls) for each in self._moving_sets])[:-1])
        goals = [
            moving_set.goal(self._tracks, place, old) for moving_set, old in zip(self._moving_sets, last, strict=True)
        ]
        self._goal = np.concatenate(goals)
        results = self._solve_best(start, np.concatenate(last))
        states = self._states(start, [state for result in results for state in result.path])
        times = [before + (frame - before) * (k + 1) / len(states) for k in range(len(states))]
        times[-1] = frame
        keys = [Key(time, state) for time, state in zip(times, states, strict=True)]
        surface, wanted = (self.deformation.surface(controls) for controls in (states[-1], self._goal))
        away = float(np.linalg.norm(surface - wanted, axis=1).max(initial=0.0))
        back = self._is_free_backward([start, *states])
        rounds = sum(result.rounds for result in results)
        return keys, _report(frame, results[0].status, rounds, away, list(results[0].blocking), len(states) - 1, back)

    def _solve_best(self, start: Floats, last: Floats) -> list[stiv.EditResult]:
        """Edit straight to the goal; if that is blocked, also drag along the animation, and take the better result.

        A drag starts with the increment of the animation and so follows a wall in front of the goal. That leads away
        from the goal where the animation emerges from the wall.
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
        """States to write: the last one if the linear motion is free in both directions, otherwise the whole path."""
        end = self.session.controls
        if np.array_equal(start, end) or not path:
            return [end]
        first, last = self.deformation.surface(start), self.deformation.surface(end)
        if self._steps.is_free(first, last) and self._steps.is_free(last, first):
            return [end]
        returns = [step for step, state in enumerate(path) if np.array_equal(state, start)]
        path = path[returns[-1] + 1 :] if returns else path  # settling may go back and take another way
        return path if path and np.array_equal(path[-1], end) else [*path, end]

    def _is_free_backward(self, states: list[Floats]) -> bool:
        """Is the path also free in the opposite direction? Tested separately."""
        surfaces = [self.deformation.surface(state) for state in states]
        steps = zip(surfaces[1:], surfaces[:-1], strict=True)
        return all(np.array_equal(one, other) or self._steps.is_free(one, other) for one, other in steps)

    def _options(self, separation: float, threads: int) -> stiv.EditOptions:
        frames = storage_frames([(len(each.controls), each.frame) for each in self._moving_sets])
        weights = np.concatenate([np.full(len(each.controls), each.weight) for each in self._moving_sets])
        return stiv.EditOptions(separation=separation, weights=weights, storage=frames, threads=threads)


def _session(
    assembly: Assembly, deformation: stiv.Deformation, controls: Floats, options: stiv.EditOptions
) -> stiv.EditSession:
    try:
        return stiv.EditSession(assembly.surface, deformation, controls, options)
    except stiv.StartIntersectsError as error:
        if intersects_only_in_render(assembly, error):
            error.add_note("only the render intersects; use --guard viewport to leave it out")
        elif name := _opening_seam(assembly):
            error.add_note(
                f"{name}: a seam opens during the animation, and its faces touch here; use Merge by Distance"
            )
        raise


def _opening_seam(assembly: Assembly) -> str:
    """The first object whose vertices coincide at the start but part later, if only faces there intersect; else ""."""
    seams = [mesh_seams(mesh.local, mesh.triangles) if mesh.strands is None else None for mesh in assembly.meshes]
    pairs = zip(assembly.meshes, seams, assembly.seams, strict=True)
    names = [mesh.owner.name for mesh, found, kept in pairs if _joins_more(found, kept)]
    if not names:
        return ""
    bodies = [assembly.surface.bodies[body] for body in assembly.surface.vertex_body[assembly.starts[:-1]]]
    merged = assemble(assembly.meshes, [body.mobility for body in bodies], seams=seams)
    return "" if len(stiv.find_intersections(merged.positions, merged.surface)) else names[0]


def _joins_more(found: Seams | None, kept: Seams | None) -> bool:
    """Do the seams of a mesh join more vertices than those that stay closed?"""
    return found is not None and (kept is None or len(found.first) < len(kept.first))


def _assembly(tracks: Sequence[Track], moving_sets: Sequence[MovingSet]) -> Assembly:
    kinds = {"still": "fixed", "rigid": "rigid", "shape": "deformable"}
    together = [frozenset(tracks[index].mesh.owner.name for index in moving_set.tracks) for moving_set in moving_sets]
    seams: list[Seams | None] = [None] * len(tracks)
    for moving_set in moving_sets:
        seams[moving_set.tracks[0]] = moving_set.control_seams
    meshes = [track.mesh for track in tracks]
    return assemble(meshes, [kinds[track.kind] for track in tracks], together, seams=seams)


def _report(*values: Any) -> dict[str, Any]:
    return dict(zip(REPORT_FIELDS, values, strict=True))
