# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the edits of a session, and the same edits again with other options.

Measures processor time of all threads, which other work on the machine hardly affects, and wall time.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import stiv

Array = NDArray[np.float64]
Report = Callable[[str], None]
Preset = Callable[..., stiv.EditOptions]


@dataclass(frozen=True)
class Task:
    """One edit: from accepted controls (m, 3) to a goal (m, 3)."""

    start: Array
    goal: Array


@dataclass(frozen=True)
class RecordedStage:
    """A stage of a session with its recorded edits."""

    stage: Any  #: a Stage of the scene library
    tasks: tuple[Task, ...]


@dataclass(frozen=True)
class EditFigures:
    """Result and cost of an edit. Times are in seconds."""

    stage: str
    status: str
    collisions: float  #: events per detection with events
    regions: int  #: disjoint patches of the last detection with events
    iterations: int  #: responses
    processor: float
    clock: float
    energy: float
    intersections: int  #: pairs of triangles in the accepted state, by the exact test
    timings: dict[str, float]
    detections: int = 0
    step: float = 0.0  #: maximum motion of a vertex to the goal, in diagonals of the movable surface

    @property
    def touches(self) -> bool:
        """Whether anything was in contact."""
        return self.iterations > 0 or self.collisions > 0


def record(session: Any, options: dict[str, Any], report: Report) -> tuple[list[RecordedStage], list[EditFigures]]:
    """Run all stages of a session. The goal of an edit depends on the result of the previous one."""
    recorded, figures = [], []
    stages = session.stages()
    stage = next(stages)
    while True:
        solver = solver_of(stage, options)
        tasks = []
        for edit in stage.edits:
            tasks.append(Task(solver.controls, edit(solver.controls)))
            figures.append(measured_edit(stage, solver, tasks[-1].goal))
        report(f"{session.name}: {stage.name}")
        recorded.append(RecordedStage(stage, tuple(tasks)))
        try:
            stage = stages.send(solver.controls)
        except StopIteration:
            return recorded, figures


def repeat(recorded: Sequence[RecordedStage], preset: Preset, options: dict[str, Any]) -> list[EditFigures]:
    """Run the recorded edits with other options, each from its recorded start.

    If the previous result is that start, the session continues with its cached pairs, as in the recording.
    """
    figures = []
    for part in recorded:
        solver = solver_of(part.stage, options, preset)
        for task in part.tasks:
            if not np.array_equal(solver.controls, task.start):
                solver.restore(task.start)
            figures.append(measured_edit(part.stage, solver, task.goal))
    return figures


def solver_of(stage: Any, options: dict[str, Any], preset: Preset = stiv.EditOptions) -> stiv.EditSession:
    """A session of the core for a stage, including the stage's options."""
    chosen = preset(**{**stage.options, **options})
    return stiv.EditSession(stage.surface, stage.deformation, stage.controls, chosen)


def measured_edit(stage: Any, solver: stiv.EditSession, goal: Array) -> EditFigures:
    """Time an edit and test its result exactly. The time includes the test of the session, not the second test."""
    before = solver.surface
    clock, processor = time.perf_counter(), time.process_time()
    result = solver.edit(goal)
    clock, processor = time.perf_counter() - clock, time.process_time() - processor
    return EditFigures(
        stage.name,
        result.status,
        result.counters["events"] / max(result.rounds, 1),
        result.patches,
        result.rounds,
        processor,
        clock,
        result.energy,
        len(stiv.find_intersections(result.surface, stage.surface)),
        result.timings,
        result.counters["detections"],
        step_size(before, stage.deformation.surface(goal)),
    )


def step_size(start: Array, goal: Array) -> float:
    """The maximum motion of a vertex over the diagonal of the moving vertices, (N, 3) each; 0 if nothing moves."""
    motion = np.linalg.norm(goal - start, axis=1)
    moves = start[motion > 0]
    return float(motion.max() / np.linalg.norm(np.ptp(moves, axis=0))) if len(moves) > 1 else 0.0
