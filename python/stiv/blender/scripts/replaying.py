# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs an edit script on the open scene through the add-on's operators, which must be registered."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import bpy

from stiv import InputError
from stiv.blender.scripts.selection import select
from stiv.blender.verify.scene_check import find_pairs, read_surface
from stiv.edit_scripts import RESHAPES, EditScript, EditStep

OF_OBJECTS = ("roles", "objects")
Report = dict[str, Any]


def replay(
    script: EditScript, on_edit: Callable[[Report], None] = lambda report: None, check: bool = False
) -> list[Report]:
    """Runs every edit of the script; `on_edit` is told of each one when it is done.

    Of each edit: `number`, `operator`, `milliseconds` of the whole operator call, what the operator says about it
    (`status`, `rounds`, `events`, `patches`, ...), and with `check` the `intersections` that the exact test, made anew,
    finds in what Blender shows afterwards. Raises InputError, naming the edit, for what cannot be selected and
    for an edit that the operator refuses; the edits before it stay done. Ends in Object Mode.
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
    """Gives the settings of a step and selects what it names. Raises InputError naming the edit."""
    try:
        _apply_settings({**script.settings, **step.settings})
        select(step)
    except InputError as error:
        raise InputError(f"edit {number} ({step.operator}): {error}") from error


def _apply_settings(settings: Mapping[str, Any]) -> None:
    """Gives the add-on's settings these values; the pivot is the median, as the format of scripts says."""
    scene = bpy.context.scene
    scene.tool_settings.transform_pivot_point = "MEDIAN_POINT"
    for name, value in settings.items():
        if name not in OF_OBJECTS and name not in scene.stiv.bl_rna.properties:
            raise InputError(f'setting "{name}": the add-on has none of this name')
        try:
            if name in OF_OBJECTS:
                _apply_to_objects(name, value)
            else:
                setattr(scene.stiv, name, value)
        except (AttributeError, TypeError, ValueError) as error:
            raise InputError(f'setting "{name}": {error}') from error


def _apply_to_objects(setting: str, values: Mapping[str, Any]) -> None:
    """Gives objects, by name, their role, or any of the add-on's settings of an object by name."""
    for name, value in values.items():
        if name not in bpy.context.scene.objects:
            raise InputError(f'setting "{setting}": there is no object "{name}" in the scene')
        chosen = bpy.context.scene.objects[name].stiv
        for field, given in {"role": value}.items() if setting == "roles" else value.items():
            if field not in chosen.bl_rna.properties:
                raise InputError(f'setting "{setting}", object "{name}": the add-on has no "{field}" of objects')
            if field == "handles":
                _apply_handles(chosen.handles, given)
            else:
                setattr(chosen, field, given)


def _apply_handles(rows: Any, groups: Sequence[str]) -> None:
    rows.clear()
    for group in groups:
        rows.add().name = group


def run_edit(step: EditStep, number: int) -> Report:
    """Calls the operator of a step on what is selected; its report. Raises InputError naming the edit."""
    begin = time.perf_counter()
    try:
        outcome = getattr(bpy.ops.stiv, step.operator)("EXEC_DEFAULT", **step.values)
    except RuntimeError as error:  # how an operator's error report arrives
        reason = str(error).strip().removeprefix("Error: ")
        raise InputError(f"edit {number} ({step.operator}): {reason}") from error
    milliseconds = 1000 * (time.perf_counter() - begin)
    if outcome != {"FINISHED"} and step.operator not in RESHAPES:  # those end so where nothing was left to do
        raise InputError(f"edit {number} ({step.operator}): the operator was cancelled")
    said = json.loads(bpy.context.window_manager.stiv_last_edit)
    return {"number": number, "operator": step.operator, "milliseconds": round(milliseconds, 3), **said}
