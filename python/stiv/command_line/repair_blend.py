# SPDX-License-Identifier: GPL-3.0-or-later
"""Repair of a .blend, with Blender as a Python module."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from stiv.command_line.blender_module import quiet_blender, require_blender, stored_settings
from stiv.command_line.progress import fraction_bar
from stiv.command_line.repair_report import Element, RepairChoices, RepairOutcome
from stiv.output_files import written_atomically


def repair_blend(source: Path, output: Path, choices: RepairChoices) -> RepairOutcome:
    """Repairs the meshes of a .blend, and saves a copy if its evaluation is free of intersections. Raises InputError.

    Uses the roles of the add-on if it is installed. The selection in the file does not change.
    """
    files = require_blender("stiv.blender.scripts.blend_files", source)
    with quiet_blender():
        context = files.open_blend(source)
        settings = _settings(context, source, choices)
        outcome = _repair(context, settings, choices, source)
        if outcome.free:
            with written_atomically(output) as temporary:
                files.save_blend(temporary)
    return outcome


def _repair(context: Any, settings: Any, choices: RepairChoices, source: Path) -> RepairOutcome:
    blender = require_blender("stiv.blender", source)
    selecting = require_blender("stiv.blender.scripts.selection", source)
    found = blender.check_scene(context, settings, strands=False)
    before = len(found.pairs)
    if before == 0:
        return RepairOutcome("already_free", "", 0, [], 0.0, "")
    meeting = {each.object for pair in found.pairs for each in (pair.first, pair.second)}
    names = choices.move or sorted(_changeable(context, meeting, settings))
    if not names:
        return RepairOutcome(
            "refused",
            "no intersecting mesh may change; change a role from Obstacle",
            before,
            _plain(found.pairs),
            0.0,
            "",
        )
    with selecting.selected(context, names), fraction_bar("repair") as progress:
        chosen = blender.RepairSettings(settings, choices.max_deviation, choices.weld)
        report = blender.repair_scene(context, chosen, progress=progress)
    left = blender.check_scene(context, settings, strands=False).pairs
    if report.changed and left:
        message = "other objects still intersect; name them with --move"
        return RepairOutcome("refused", message, before, _plain(left), report.deviation, report.contracted)
    status = "refused" if left else report.status
    return RepairOutcome(status, report.message, before, _plain(left), report.deviation, report.contracted)


def _settings(context: Any, source: Path, choices: RepairChoices) -> Any:
    settings = stored_settings(context, source)
    separation, guard = choices.separation or settings.separation, choices.guard or settings.guard
    return replace(settings, separation=separation, guard=guard, time_budget=choices.time_limit)


def _changeable(context: Any, names: set[str], settings: Any) -> set[str]:
    """Meshes among these objects that are not obstacles."""
    objects = context.view_layer.objects
    return {name for name in names if objects[name].type == "MESH" and settings.role(name) != "obstacle"}


def _plain(pairs: Any) -> list[tuple[Element, Element]]:
    return [
        ((a.object, a.kind, a.number), (b.object, b.kind, b.number)) for a, b in ((p.first, p.second) for p in pairs)
    ]
