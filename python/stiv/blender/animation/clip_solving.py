# SPDX-License-Identifier: GPL-3.0-or-later
"""Follows an animation in time from a free frame; corrections keep it free of intersections."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

import stiv
from stiv.blender.animation.clip import Clip
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import Assembly
from stiv.blender.settings import EditSettings

LONGEST_TURN, LONGEST_TIME = 0.2, 0.5  # radians and frames of a step, whose vertices move on straight lines
TRIES = 4  # solves toward a frame, each with a new Jacobian
GAIN = 1e-3  # change of the values below which another solve is of no use


@dataclass(frozen=True)
class Reached:
    """Where a solve toward a frame ended: the correction, (k,), and the frame, which is earlier if it was blocked."""

    correction: Floats
    frame: float


class ClipSolver:
    """Solves for corrections. Every state is free of intersections, and so is the path to it."""

    def __init__(self, clip: Clip, settings: EditSettings) -> None:
        self._clip, self.settings = clip, settings
        self.assembly: Assembly = clip.assembly
        self._static = stiv.IntersectionTest(self.assembly.surface, settings.threads)
        self._steps = stiv.StepCheck(self.assembly.surface, settings.threads)
        self._lower, self._upper = clip.limits()
        self._vertices = self.assembly.vertices_of(clip.moving)

    def is_free(self, surface: Floats) -> bool:
        """Is a surface, (N, 3), free of intersections?"""
        return len(self._static.find(surface)) == 0

    def is_step_free(self, start: Floats, end: Floats) -> bool:
        """Is the linear motion between two surfaces free of intersections?"""
        return np.array_equal(start, end) or self._steps.is_free(start, end)

    def intersections(self, surface: Floats) -> list[tuple[str, str]]:
        """Names of the objects of intersecting pairs."""
        pairs = self._static.find(surface)
        found = self.assembly.face_pairs(pairs)[0]
        return sorted({(pair.first.object, pair.second.object) for pair in found})

    def follow(
        self, start: Reached, goals: Sequence[tuple[float, Floats]], separation: float = 0.0
    ) -> Iterator[Reached]:
        """From a free state through goals: frames, each with the correction wanted, (k,). Blocked ends are kept."""
        values = np.append(start.correction, start.frame)
        deformation = self._deformation(values, goals[0][0])
        session = self._session(deformation, values, separation)
        for frame, wanted in goals:
            goal = np.append(np.clip(wanted, self._lower[:-1], self._upper[:-1]), frame)
            for _ in range(TRIES):
                before = deformation.values(session.controls)
                deformation.set_jacobian(self._clip.jacobian(before, frame - before[-1]))
                status = session.drag(deformation.controls(goal)).status
                if status not in ("reached", "unchanged"):
                    session.settle()
                values = deformation.values(session.controls)
                if abs(values[-1] - frame) < 1e-9 or np.abs(values - before).max() < GAIN:
                    break
            yield Reached(values[:-1].copy(), float(values[-1]))

    def _deformation(self, values: Floats, towards: float) -> stiv.ScalarDeformation:
        jacobian = self._clip.jacobian(values, towards - float(values[-1]))
        longest = np.full(len(values), LONGEST_TURN)
        longest[-1] = LONGEST_TIME
        return stiv.scalars(self._clip.surface, jacobian, lower=self._lower, upper=self._upper, longest_step=longest)

    def _session(self, deformation: stiv.ScalarDeformation, values: Floats, separation: float) -> stiv.EditSession:
        whole = self._clip.whole_surface(float(values[-1]), values[:-1])
        weights = np.ones(len(values))
        weights[-1] = 0  # the time follows its goal
        shared = self.settings.shared()
        if separation > 0:
            shared["separation"] = separation
        options = stiv.EditOptions(**shared, weights=weights)
        moved = stiv.concatenate([(deformation, self._vertices)], whole)
        return stiv.EditSession(self.assembly.surface, moved, deformation.controls(values), options)
