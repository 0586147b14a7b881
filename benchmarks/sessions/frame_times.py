# SPDX-License-Identifier: GPL-3.0-or-later
"""Times the frames of an edit script in Blender, including Blender's evaluation.

A step with repetitions is one drag with a frame per repetition. A frame solves toward the absolute goal,
writes, evaluates, reads back and tests. A step that reshapes (contract, expand, ...) is one operator call.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

import stiv
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.scene.arrays import Floats
from stiv.blender.scripts.replaying import prepare, run_edit
from stiv.blender.settings import EditSettings
from stiv.edit_scripts import TRANSFORMS, EditScript, EditStep


@dataclass(frozen=True)
class FrameTime:
    """One frame, in wall time: waiting threads of Blender also use processor time.

    Attributes:
        stage: operator and objects.
        seconds: total.
        evaluation: Blender's evaluation.
        writing: the rest of writing, reading back and the exact test.
        solved: timings of the core (see stiv.EditResult).
        touches: whether anything was in contact.
        passed: whether the displayed state passed the exact test.
    """

    stage: str
    seconds: float
    evaluation: float
    writing: float
    solved: dict[str, float]
    touches: bool
    passed: bool


def frame_times(script: EditScript, settings_of: Callable[[Any], EditSettings]) -> list[FrameTime]:
    """Runs a script on the open scene. settings_of: returns the add-on's settings of a scene. Raises
    InputError.
    """
    frames: list[FrameTime] = []
    with _evaluation_timed() as clock:
        for step in script.steps:
            prepare(step, script, len(frames))
            make = _drag if step.operator in TRANSFORMS else _reshape
            frames += make(step, settings_of, clock)
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    return frames


def goal_matrix(step: EditStep, repetition: float, pivot: Floats) -> Floats:
    """The absolute transform (4, 4) of a drag after a number of repetitions, which may be fractional.

    The step is a move, or a scale about `pivot`, (3,).
    """
    matrix = np.eye(4)
    value = np.array(step.values["value"])
    if step.operator == "move":
        matrix[:3, 3] = repetition * value
    else:
        factors = value**repetition
        matrix[:3, :3], matrix[:3, 3] = np.diag(factors), (1 - factors) * pivot
    return matrix


def _drag(step: EditStep, settings_of: Callable[[Any], EditSettings], clock: list[float]) -> Iterator[FrameTime]:
    if step.operator == "rotate":
        raise stiv.InputError("rotate: frame times are of scripts that move, scale and reshape")
    edit = BlenderEdit.begin(bpy.context, settings_of(bpy.context.scene), step.operator)
    pivot = edit.controls.mean(axis=0)
    for repetition in range(1, step.repeat + 1):
        clock[0], begin = 0.0, time.perf_counter()
        result = edit.drag(goal_matrix(step, repetition, pivot))
        solved = time.perf_counter()
        passed = edit.write().passed
        end = time.perf_counter()
        touches = result.rounds > 0 or len(result.events) > 0
        yield FrameTime(
            name_of(step), end - begin, clock[0], end - solved - clock[0], dict(result.timings), touches, passed
        )


def _reshape(step: EditStep, settings_of: Callable[[Any], EditSettings], clock: list[float]) -> Iterator[FrameTime]:
    for _ in range(step.repeat):
        clock[0], begin = 0.0, time.perf_counter()
        run_edit(step, 0)
        end = time.perf_counter()
        said = json.loads(bpy.context.window_manager.stiv_last_edit)
        timings = said.get("timings", {})
        yield FrameTime(
            name_of(step), end - begin, clock[0], 0.0, timings, said["rounds"] > 0, not said.get("pairs_left", 0)
        )


def name_of(step: EditStep) -> str:
    """Operator, mode and objects of a step."""
    return f"{step.operator} {step.mode.lower()} {', '.join(step.objects)}"


@contextmanager
def _evaluation_timed() -> Iterator[list[float]]:
    """Within, adds the seconds of Blender's evaluations to the number in the list."""
    total, begun = [0.0], [0.0]

    def before(*_: Any) -> None:
        begun[0] = time.perf_counter()

    def after(*_: Any) -> None:
        total[0] += time.perf_counter() - begun[0]

    handlers = bpy.app.handlers
    handlers.depsgraph_update_pre.append(before)
    handlers.depsgraph_update_post.insert(0, after)
    try:
        yield total
    finally:
        handlers.depsgraph_update_pre.remove(before)
        handlers.depsgraph_update_post.remove(after)
