# SPDX-License-Identifier: GPL-3.0-or-later
"""One edit of the open scene: begin, drag or apply, write, restore."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import bpy
import numpy as np
from numpy.typing import ArrayLike

import stiv
from stiv import InputError
from stiv.blender.arrays import Floats
from stiv.blender.assembly import Assembly, assemble
from stiv.blender.evaluated_scene import read_scene
from stiv.blender.participants import make_parts
from stiv.blender.parts import Part
from stiv.blender.roles import find_movers
from stiv.blender.settings import EditSettings, check_kind
from stiv.blender.summary import Summary, summarise
from stiv.blender.transform_path import increments, transform_at
from stiv.blender.verification import Verifier, WriteReport

STEP = 0.02  # longest increment of a typed value, in diagonals of what moves
MOST_STEPS = 200


class BlenderEdit:
    """An edit from its beginning to its last state written. Keeps no reference of Blender's between calls."""

    def __init__(
        self, assembly: Assembly, parts: Sequence[Part], session: stiv.EditSession, summary: Summary, verifier: Verifier
    ) -> None:
        """Use `begin`."""
        self.summary = summary
        self._assembly = assembly
        self._parts = tuple(parts)
        self._session = session
        self._verifier = verifier
        self._start = _stacked([part.controls for part in parts])
        self._goal = self._start
        self._shown = self._start

    @classmethod
    def begin(cls, context: bpy.types.Context, settings: EditSettings, kind: str) -> BlenderEdit:
        """Read the scene for an edit of this kind ("move", "rotate", "scale"); changes nothing.

        Raises InputError naming object, element and ways out, StartIntersectsError for a start that intersects.
        """
        check_kind(kind)
        movers = find_movers(context, settings)
        scene = read_scene(context, lambda name: settings.role(name) != "ignored")
        parts, groups = make_parts(context, movers, scene.meshes, settings, kind)
        if not any(part.rule.moves for part in parts):
            raise InputError("nothing is selected that may move; select vertices, points or objects with a surface")
        mobility = _mobility(len(scene.meshes), parts)
        assembly = assemble(scene.meshes, mobility, [group.members for group in groups], settings.ignored_pairs)
        summary = summarise(assembly, parts, scene.hidden)
        verifier = Verifier(assembly, settings.threads)
        return cls(assembly, parts, _session(assembly, parts, settings), summary, verifier)

    @property
    def controls(self) -> Floats:
        """Accepted controls of all parts, (m, 3)."""
        return self._session.controls

    @property
    def surface(self) -> Floats:
        """The accepted surface, (N, 3)."""
        return self._session.surface

    @property
    def assembly(self) -> Assembly:
        """The surface's objects and faces."""
        return self._assembly

    def drag(self, matrix: ArrayLike, **execution: Any) -> stiv.EditResult:
        """Solve for an absolute goal: `matrix`, (4, 4), moves what is selected from where it was at the beginning.

        `cancel` and `progress` as of stiv.EditSession. Raises InputError for a matrix that is not finite.
        """
        self._goal = self._goal_of(_checked(matrix))
        return self._session.drag(self._goal, **execution)

    def apply(self, matrix: ArrayLike, **execution: Any) -> stiv.EditResult:
        """Solve for the same goal given at once: approached in increments of a drag's size, then settled."""
        target = _checked(matrix)
        results = []
        for fraction in self._fractions(target):
            results.append(self.drag(transform_at(target, fraction), **execution))
            if results[-1].status in ("cancelled", "budget"):
                return _summed(results)
        return _summed([*results, self.settle(**execution)])

    def settle(self, **execution: Any) -> stiv.EditResult:
        """Solve again toward the last goal."""
        return self._session.settle(**execution)

    def write(self) -> WriteReport:
        """Write the accepted controls, read Blender's evaluation back and test it; on failure put back the last state.

        Raises SceneChangedError when an object is gone or was changed.
        """
        accepted = self._session.controls
        self._write(accepted)
        report = self._verifier.verify(bpy.context, self._session.surface)
        if report.passed:
            self._shown = accepted
            return report
        self._write(self._shown)
        self._session.restore(self._shown)
        return report

    def restore(self) -> None:
        """Put everything back, bit by bit, as it was at the beginning. Raises SceneChangedError."""
        for part in self._parts:
            part.writer.restore()
        bpy.context.view_layer.update()
        self._session.restore(self._start)
        self._goal = self._shown = self._start

    def _write(self, controls: Floats) -> None:
        for part, rows, start in zip(self._parts, self._split(controls), self._split(self._start), strict=True):
            if np.array_equal(rows, start):
                part.writer.restore()
            else:
                part.writer.write(rows)
        bpy.context.view_layer.update()

    def _split(self, controls: Floats) -> list[Floats]:
        return np.split(controls, np.cumsum([len(part.controls) for part in self._parts])[:-1])

    def _goal_of(self, matrix: Floats) -> Floats:
        last = self._split(self._goal)
        return _stacked(
            [part.rule.goal(part.controls, old, matrix) for part, old in zip(self._parts, last, strict=True)]
        )

    def _fractions(self, target: Floats) -> Iterator[float]:
        moving = [index for part in self._parts for index in part.surfaces]
        points = np.concatenate([self._assembly.positions[self._assembly.vertices(index)] for index in moving])
        diagonal = float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0
        count = increments(target, points, STEP * diagonal, MOST_STEPS)
        return ((k + 1) / count for k in range(count))


def _checked(matrix: ArrayLike) -> Floats:
    checked = np.asarray(matrix, np.float64)
    if checked.shape != (4, 4) or not np.isfinite(checked).all():
        raise InputError("transform: must be a matrix of 4 x 4 finite numbers")
    return checked


def _stacked(controls: Sequence[Floats]) -> Floats:
    return np.concatenate([np.empty((0, 3)), *controls])


def _mobility(count: int, parts: Sequence[Part]) -> list[str]:
    mobility = ["fixed"] * count
    for part in parts:
        for index in part.surfaces:
            mobility[index] = "rigid" if part.role == "rigid" else "deformable"
    return mobility


def _session(assembly: Assembly, parts: Sequence[Part], settings: EditSettings) -> stiv.EditSession:
    moved = [(part.deformation, _vertices(assembly, part)) for part in parts]
    deformation = stiv.concatenate(moved, assembly.positions)
    frames, first = [], 0
    for part in parts:
        if part.frame is not None:
            frames.append(stiv.StorageFrame(first, len(part.controls), part.frame))
        first += len(part.controls)
    options = stiv.EditOptions(
        separation=settings.separation,
        smoothness=settings.smoothness,
        weights=np.concatenate([part.weights for part in parts]),
        constraints=settings.constraints,
        single_precision=bool(frames),
        storage=frames,
        time_budget=settings.time_budget,
        threads=settings.threads,
    )
    return stiv.EditSession(assembly.surface, deformation, _stacked([part.controls for part in parts]), options)


def _vertices(assembly: Assembly, part: Part) -> Any:
    return np.concatenate([assembly.vertices(index) for index in part.surfaces])


def _summed(results: Sequence[stiv.EditResult]) -> stiv.EditResult:
    """The last result, with the work of all; a settling that found nothing to do leaves the status before it."""
    last = results[-1]
    told = [result for result in results if result.status != "unchanged"]
    with_events = [result for result in results if len(result.events)]
    return replace(
        last,
        status=told[-1].status if told else last.status,
        fraction=min(result.fraction for result in results),
        rounds=sum(result.rounds for result in results),
        events=with_events[-1].events if with_events else last.events,
        patches=with_events[-1].patches if with_events else last.patches,
        timings={name: sum(result.timings[name] for result in results) for name in last.timings},
        counters={name: sum(result.counters[name] for result in results) for name in last.counters},
    )
