# SPDX-License-Identifier: GPL-3.0-or-later
"""Corrects the bones and objects of an animation: as little as possible, smoothly, free of intersections."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from stiv import InputError
from stiv.blender.animation.animated_parts import Values, turn_between
from stiv.blender.animation.clip import Clip
from stiv.blender.animation.clip_solving import ClipSolver, Reached
from stiv.blender.animation.corrective_keys import Corrective, CorrectiveSolver, runs_of
from stiv.blender.animation.smoothing import envelope, largest_acceleration
from stiv.blender.scene.arrays import Flags, Floats
from stiv.blender.settings import EditSettings

WIDTHS = (2, 3, 4, 5, 6, 8, 10, 13, 16, 20, 26, 32)  # frames over which a correction is held and averaged
ROUNDS = 12  # of smoothing and solving what intersects again
PATIENCE = 3  # rounds that may pass without fewer intersecting moments
MORE = 1.15  # factor of a need that smoothing did not meet
SMALL = 1e-6  # radians or units below which a correction is none


@dataclass(frozen=True)
class Correction:
    """Corrections of an animation.

    Attributes:
        frames: whole and ascending.
        values: (F, k), of the parts of the clip.
        failed: frames that have no correction, or still intersect, ascending.
        shaped: frames that corrective shape keys correct, ascending.
        acceleration: largest one, divided by that of the input.
        turns: change of the rotation of each part at each frame, (F, p), degrees.
        distances: largest distance of a vertex from the animation at each frame, (F,).
        needed: whether each frame intersected, or the motion to one of its neighbours did, (F,).
    """

    frames: tuple[int, ...]
    values: Floats
    failed: tuple[int, ...]
    acceleration: float
    turns: Floats
    distances: Floats
    needed: Flags
    shaped: tuple[int, ...] = ()


def moments_of(frames: Sequence[int]) -> list[float]:
    """Frames in steps of 1, and the middles between them."""
    found: list[float] = np.linspace(frames[0], frames[-1], 2 * len(frames) - 1).tolist()
    return found


class Corrector:
    """Corrects a clip at whole frames; it is tested there and halfway between them, and the motion between these."""

    def __init__(
        self,
        clip: Clip,
        frames: Sequence[int],
        settings: EditSettings,
        acceleration: float,
        on_frame: Callable[[str], None] = lambda status: None,
    ) -> None:
        """acceleration: largest one, divided by that of the input."""
        self._clip, self._frames, self._bound, self._on_frame = clip, list(frames), acceleration, on_frame
        self._solver = ClipSolver(clip, settings)
        none = np.zeros((len(frames), clip.count))
        self._values = self._part_values(none)
        self._between: dict[tuple[int, float], Floats] = {}
        self._input = self._surfaces(none)
        self._is_cyclic = self._repeats()
        self._input_acceleration = self._accelerations(none)

    def correct(self) -> Correction:
        """Solve, smooth and test until the whole clip is free. Raises InputError if no frame is free."""
        none = np.zeros((len(self._frames), self._clip.count))
        failing = self._failing(self._input)
        needed = self._frames_of(failing)
        raw, failed = self._solve(needed)
        smooth, need, fewest, stalled = none, raw.copy(), 2 * len(self._frames), 0
        for _ in range(ROUNDS):
            smooth = self._smooth(need)
            again = self._failing(self._surfaces(smooth)) & ~self._moments_of(failed)
            stalled = 0 if again.sum() < fewest else stalled + 1
            fewest = min(fewest, int(again.sum()))
            if not again.any() or stalled > PATIENCE:
                break
            before, need = need, self._limited(self._raise(need, smooth, raw, again))
            if np.array_equal(before, need):
                break
        left = self._frames_of(self._failing(self._surfaces(smooth))) | failed
        names = tuple(frame for frame, is_left in zip(self._frames, left.tolist(), strict=True) if is_left)
        return Correction(
            tuple(self._frames),
            smooth,
            names,
            self._ratio(smooth),
            self._turns(smooth),
            self._distances(smooth),
            needed,
        )

    def correct_by_shapes(self, correction: Correction) -> tuple[Correction, list[Corrective]]:
        """Shape keys for the frames that failed; those without a solution still fail. Raises InputError by name."""
        solver = CorrectiveSolver(self._clip, self._solver, lambda moment: self._at(correction.values, moment))
        bad = self._with_neighbours(self._failing(self._surfaces(correction.values)))
        found: list[Corrective] = []
        failed: set[int] = set()
        distances = correction.distances.copy()
        for run in runs_of(np.flatnonzero(bad).tolist()):
            first, last = (self._frames[0] + place / 2 for place in run)
            solved = solver.solve(first, last, (self._frames[0], self._frames[-1]))
            if solved is None:
                failed |= {frame for frame in self._frames if first <= frame <= last}
                continue
            found += solved.keys
            for k in (k for k, frame in enumerate(self._frames) if frame in solved.surfaces):
                distances[k] = _largest_distance(solved.surfaces[self._frames[k]], self._input[2 * k])
        failed &= set(correction.failed)
        shaped = tuple(sorted({frame for frame in self._frames if frame in {key.moment for key in found}}))
        return replace(correction, failed=tuple(sorted(failed)), shaped=shaped, distances=distances), found

    def _with_neighbours(self, moments: Flags) -> Flags:
        """The moments, and those beside them, where the motion to the free pose begins and ends."""
        found = moments.copy()
        found[:-1] |= moments[1:]
        found[1:] |= moments[:-1]
        return found

    def intersecting(self, moments: Sequence[float]) -> list[float]:
        """The moments at which the animation itself intersects, or begins a motion to the next one that does."""
        none = np.zeros(self._clip.count)
        surfaces = [self._clip.whole_surface(moment, none) for moment in moments]
        ends = zip(surfaces, [*surfaces[1:], surfaces[-1]], strict=True)
        is_free = [self._solver.is_free(one) and self._solver.is_step_free(one, other) for one, other in ends]
        return [moment for moment, free in zip(moments, is_free, strict=True) if not free]

    def _at(self, values: Floats, moment: float) -> Floats:
        """Correction at any moment, (k,): linear keys of the changed parts also change their motion between frames."""
        place, fraction = divmod(moment - self._frames[0], 1)
        first = int(place)
        if fraction == 0:
            return np.asarray(values[first], np.float64)
        ends = values[first : first + 2]
        is_keyed = np.concatenate([np.full(each.shape[1], each.any()) for each in self._split(ends)])
        linear = (1 - fraction) * ends[0] + fraction * ends[1]
        return np.asarray(linear + np.where(is_keyed, self._linear_between(first, fraction), 0), np.float64)

    def _split(self, values: Floats) -> list[Floats]:
        """The columns of each part."""
        return np.split(values, np.cumsum([part.count for part in self._clip.parts])[:-1], axis=1)

    def _linear_between(self, first: int, fraction: float) -> Floats:
        """The correction that gives linear interpolation between two frames, (k,)."""
        if (first, fraction) not in self._between:
            present = self._clip.pose(self._frames[first] + fraction, np.zeros(self._clip.count))
            ends = zip(self._clip.parts, present, *self._values[first : first + 2], strict=True)
            found = [part.correction_between(*own, fraction) for part, *own in ends]
            self._between[first, fraction] = np.concatenate(found)
        return self._between[first, fraction]

    def _surfaces(self, values: Floats) -> list[Floats]:
        return [self._clip.whole_surface(each, self._at(values, each)) for each in moments_of(self._frames)]

    def _failing(self, surfaces: Sequence[Floats]) -> Flags:
        """The moments that intersect, or begin or end a motion that does."""
        bad = np.array([not self._solver.is_free(each) for each in surfaces])
        for k in np.flatnonzero(~(bad[1:] | bad[:-1])).tolist():
            if not self._solver.is_step_free(surfaces[k], surfaces[k + 1]):
                bad[k if k % 2 else k + 1] = True  # the middle between two frames
        return bad

    def _frames_of(self, moments: Flags) -> Flags:
        """The frames of failing moments; both frames of a middle."""
        found = moments[::2].copy()
        found[:-1] |= moments[1::2]
        found[1:] |= moments[1::2]
        return found

    def _moments_of(self, frames: Flags) -> Flags:
        """The moments at frames and next to them."""
        found = np.zeros(2 * len(frames) - 1, bool)
        found[::2] = frames
        found[1::2] = frames[:-1] | frames[1:]
        return found

    def _solve(self, needed: Flags) -> tuple[Floats, Flags]:
        """Corrections of each run of needed frames, (F, k), and the frames without one."""
        raw, failed = np.zeros((len(needed), self._clip.count)), np.zeros(len(needed), bool)
        if needed.all():
            raise InputError("all frames intersect; choose a range with a frame that is free")
        for first, last in runs_of(np.flatnonzero(needed).tolist()):
            found = [self._solve_run(first, last, forward, needed) for forward in (True, False)]
            best = min((each for each in found if each is not None), key=lambda each: each[1].sum())
            raw, failed = np.where(np.abs(best[0]) > np.abs(raw), best[0], raw), failed | best[1]
        return raw, failed

    def _solve_run(self, first: int, last: int, forward: bool, needed: Flags) -> tuple[Floats, Flags] | None:
        """Follow a run of frames from the free frame before or after it, until the correction is none again."""
        begin = first - 1 if forward else last + 1
        if not 0 <= begin < len(needed):
            return None
        raw, failed = np.zeros((len(needed), self._clip.count)), np.zeros(len(needed), bool)
        places = list(range(begin + 1, len(needed)) if forward else range(begin - 1, -1, -1))
        goals = [(float(self._frames[k]), np.zeros(self._clip.count)) for k in places]
        states = self._solver.follow(Reached(np.zeros(self._clip.count), float(self._frames[begin])), goals)
        for k, state in zip(places, states, strict=False):
            is_there = abs(state.frame - self._frames[k]) < 1e-6
            is_in_run = first <= k <= last
            if not is_in_run and not is_there:
                break  # the wrong side of a thin surface: the test of the smooth corrections names its frames
            raw[k], failed[k] = state.correction, not is_there
            self._on_frame("corrected" if is_there else "blocked")
            if not is_in_run and np.abs(state.correction).max() < SMALL:
                break
        return raw, failed

    def _smooth(self, need: Floats) -> Floats:
        """The narrowest envelope that keeps the bound on the acceleration, or else the one with the least."""
        found = [need]
        for width in WIDTHS:
            found.append(np.where(np.abs(smooth := envelope(need, width, self._is_cyclic)) < SMALL, 0, smooth))
            if self._ratio(found[-1]) <= self._bound:
                return self._limited(found[-1])
        return self._limited(min(found[1:], key=self._ratio))

    def _limited(self, values: Floats) -> Floats:
        lower, upper = self._clip.limits()
        return np.clip(values, lower[:-1], upper[:-1])

    def _raise(self, need: Floats, smooth: Floats, raw: Floats, again: Flags) -> Floats:
        """Needs, (F, k), that keep clear where the smooth corrections intersect.

        Each state is reached from the solved one on a free path: a smooth one may be free on the wrong side.
        """
        result = need.copy()
        for k in np.flatnonzero(self._frames_of(again)).tolist():
            moments = [each for each in (2 * k, 2 * k - 1, 2 * k + 1) if 0 <= each < len(again) and again[each]]
            missed = False
            for moment in dict.fromkeys((2 * k, *moments)):
                time = self._frames[0] + moment / 2
                goal = self._at(smooth, time)
                *_, state = self._solver.follow(Reached(raw[k], float(self._frames[k])), [(time, goal)])
                change = state.correction - goal
                if np.abs(change).max() > SMALL:
                    missed = True
                    result[k] = _larger(result[k], goal + MORE * change, change)
            if not missed:  # only the motion between two free states intersects
                result[k] = _larger(result[k], MORE * smooth[k], smooth[k])
        return result

    def _part_values(self, values: Floats) -> list[list[Values]]:
        return [list(self._clip.pose(frame, own)) for frame, own in zip(self._frames, values, strict=True)]

    def _turns(self, values: Floats) -> Floats:
        """Change of the rotation of each part, (F, p), degrees."""
        corrected = self._part_values(values)
        modes = [part.mode for part in self._clip.parts]
        rows = [
            [np.linalg.norm(turn_between(mode, one, other)) for mode, one, other in zip(modes, a, b, strict=True)]
            for a, b in zip(self._values, corrected, strict=True)
        ]
        found: Floats = np.degrees(np.array(rows))
        return found

    def _distances(self, values: Floats) -> Floats:
        surfaces = [self._clip.whole_surface(f, own) for f, own in zip(self._frames, values, strict=True)]
        return np.array([_largest_distance(*pair) for pair in zip(surfaces, self._input[::2], strict=True)])

    def _repeats(self) -> bool:
        """Does the last frame show the first one again?"""
        first, last = self._input[0], self._input[-1]
        return len(self._frames) > 2 and bool(np.abs(first - last).max() < 1e-4 * np.ptp(first, axis=0).max())

    def _accelerations(self, values: Floats) -> tuple[float, float]:
        """Largest acceleration of a vertex, and of the rotation of a part."""
        surfaces = [self._clip.whole_surface(f, own) for f, own in zip(self._frames, values, strict=True)]
        modes = [part.mode for part in self._clip.parts]
        turns = [
            [turn_between(mode, one, other) for mode, one, other in zip(modes, before, after, strict=True)]
            for before, after in pairwise(self._part_values(values))
        ]
        steps = (np.diff(np.array(surfaces), axis=0), np.array(turns))
        vertices, parts = (largest_acceleration(each, self._is_cyclic) for each in steps)
        return vertices, parts

    def _ratio(self, values: Floats) -> float:
        """Largest acceleration, divided by that of the input: of vertices or of angles, whichever is larger."""
        pairs = zip(self._accelerations(values), self._input_acceleration, strict=True)
        return max(after / before if before > 0 else (0.0 if after == 0 else np.inf) for after, before in pairs)


def _largest_distance(one: Floats, other: Floats) -> float:
    return float(np.linalg.norm(one - other, axis=1).max())


def _larger(need: Floats, other: Floats, change: Floats) -> Floats:
    """Another need, (k,), where it goes further in the direction of a change."""
    return np.where((other - need) * np.sign(change) > 0, other, need)
