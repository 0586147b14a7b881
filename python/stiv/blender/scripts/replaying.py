# SPDX-License-Identifier: GPL-3.0-or-later
"""Replays an edit script on the open scene through the add-on's operators, which must be registered."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import bpy

from stiv import InputError
from stiv.blender.scripts.selection import select
from stiv.blender.verify.scene_check import find_pairs, read_surface
from stiv.choices import FORMER_RESPONSES
from stiv.edit_scripts import RESHAPES, EditScript, EditStep

OBJECT_SETTINGS = ("roles", "objects")
Report = dict[str, Any]


def replay(
    script: EditScript, on_edit: Callable[[Report], None] = lambda report: None, check: bool = False
) -> list[Report]:
    """Run every edit of the script; `on_edit` is called with the report of each.

    A report has `number`, `operator`, `milliseconds` of the operator call, the operator's own results (`status`,
    `rounds`, `events`, `patches`, ...), and with `check` the number of `intersections` that a new exact test finds.
    Raises InputError naming the edit if its selection or the operator fails; earlier edits remain. Ends in Object Mode.
    """
    reports: list[Report] = []
    selected: EditStep | None = None
    try:
        for step in script.edits():
            if step is not selected:
                prepare(step, script, len(reports))
                selected = step
            reports.append(run_edit(step, len(reports)))
            if check:
                reports[-1]["intersections"] = len(find_pairs(read_surface(bpy.context)))
            on_edit(reports[-1])
    finally:
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
    return reports


def prepare(step: EditStep, script: EditScript, number: int) -> None:
    """Apply the settings of a step and select its objects. Raises InputError naming the edit."""
    try:
        _apply_settings({**script.settings, **step.settings})
        select(step)
    except InputError as error:
        raise InputError(f"edit {number} ({step.operator}): {error}") from error


def _apply_settings(settings: Mapping[str, Any]) -> None:
    """Set the add-on's settings; the pivot is the median point, as the format of scripts defines."""
    scene = bpy.context.scene
    scene.tool_settings.transform_pivot_point = "MEDIAN_POINT"
    for name, value in settings.items():
        if name not in OBJECT_SETTINGS and name not in scene.stiv.bl_rna.properties:
            raise InputError(f'setting "{name}": the add-on has no such setting')
        try:
            if name in OBJECT_SETTINGS:
                _apply_to_objects(name, value)
            elif name == "object_response":
                scene.stiv.object_response = FORMER_RESPONSES.get(value, value)
            else:
                setattr(scene.stiv, name, value)
        except (AttributeError, TypeError, ValueError) as error:
            raise InputError(f'setting "{name}": {error}') from error


def _apply_to_objects(setting: str, values: Mapping[str, Any]) -> None:
    """Set the roles ("roles") or any settings ("objects") of objects, by object name."""
    for name, value in values.items():
        if name not in bpy.context.scene.objects:
            raise InputError(f'setting "{setting}": there is no object "{name}" in the scene')
        chosen = bpy.context.scene.objects[name].stiv
        for field, setting_value in {"role": value}.items() if setting == "roles" else value.items():
            if field not in chosen.bl_rna.properties:
                raise InputError(f'setting "{setting}", object "{name}": the add-on has no "{field}" of objects')
            if field == "handles":
                _apply_handles(chosen.handles, setting_value)
            else:
                setattr(chosen, field, setting_value)


def _apply_handles(rows: Any, groups: Sequence[str]) -> None:
    rows.clear()
    for group in groups:
        rows.add().name = group


def run_edit(step: EditStep, number: int) -> Report:
    """Call the operator of a step on the selection; returns the report. Raises InputError naming the edit."""
    begin = time.perf_counter()
    try:
        outcome = getattr(bpy.ops.stiv, step.operator)("EXEC_DEFAULT", **step.values)
    except RuntimeError as error:  # an operator's error report
        reason = str(error).strip().removeprefix("Error: ")
        raise InputError(f"edit {number} ({step.operator}): {reason}") from error
    milliseconds = 1000 * (time.perf_counter() - begin)
    if (
        outcome != {"FINISHED"} and step.operator not in RESHAPES
    ):  # reshaping operators also end so if nothing was left to do
        raise InputError(f"edit {number} ({step.operator}): the operator was cancelled")
    said = json.loads(bpy.context.window_manager.stiv_last_edit)
    return {"number": number, "operator": step.operator, "milliseconds": round(milliseconds, 3), **said}
