# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares edits of the dressing's shirt with Blender's cloth simulation: same start and goal, a frame per
edit.
"""

from __future__ import annotations

import importlib
import importlib.util
from typing import Any

import numpy as np

import stiv
from benchmarks.sessions.running import Array, RecordedStage, Report, record
from blend_fixtures.scenes.sessions import catalogue, dressing
from stiv import InputError

BODIES = ("Ogre", "Shirt")
STAGES = ("expand", "shrink")  #: stages of the session that a cloth simulation can do


def cloth(report: Report) -> list[dict[str, Any]]:
    """A row for each of STAGES. Raises InputError without Blender's module."""
    if importlib.util.find_spec("bpy") is None:
        raise InputError("bench cloth: Blender's Python module is not installed (pip install bpy)")
    simulation = importlib.import_module("benchmarks.sessions.cloth_simulation")
    recorded, figures = record(catalogue.table_sessions()["dressing"], {"threads": 1}, report)
    rows = []
    for number, part in enumerate(recorded):
        name = part.stage.name
        if name not in STAGES:
            continue
        start, wanted = surface_at(part, part.tasks[0].start), wanted_at_end(part)
        ours = surface_at(part, _end(recorded, number))
        body, shirt = (part.stage.surface.vertex_body == _index(part, owner) for owner in BODIES)
        shrink = 0.0 if name == "expand" else 1 - dressing.SHRINK ** len(part.tasks)
        run = simulation.simulate_cloth(
            (start[shirt], _triangles(part, shirt)),
            (start[body], _triangles(part, body)),
            wanted[body],
            len(part.tasks),
            shrink,
        )
        theirs = wanted.copy()
        theirs[shirt] = run.cloth
        mine = [figure for figure in figures if figure.stage == name]
        report(f"cloth: {name}")
        rows.append(
            {
                "scene": f"dressing, {name}",
                "edits": len(part.tasks),
                "kept": kept(start, wanted, ours),
                "kept_by_cloth": kept(start, wanted, theirs),
                "processor_ms_per_edit": 1000 * float(np.mean([figure.processor for figure in mine])),
                "processor_ms_per_frame": 1000 * float(np.mean(run.seconds)),
                "intersections": len(stiv.find_intersections(ours, part.stage.surface)),
                "intersections_by_cloth": len(stiv.find_intersections(theirs, part.stage.surface)),
            }
        )
    return rows


def kept(start: Array, wanted: Array, reached: Array) -> float:
    """The fraction of the motion to the goal that is reached: 1 - |q - q~| / |q0 - q~|."""
    return float(1 - np.linalg.norm(reached - wanted) / np.linalg.norm(start - wanted))


def surface_at(part: RecordedStage, controls: Array) -> Array:
    """The surface (N, 3) for controls of a stage."""
    surface: Array = part.stage.deformation.surface(controls)
    return surface


def wanted_at_end(part: RecordedStage) -> Array:
    """The surface of the goal of all edits of a stage, without obstacles."""
    controls = part.tasks[0].start
    for edit in part.stage.edits:
        controls = edit(controls)
    return surface_at(part, controls)


def _end(recorded: list[RecordedStage], number: int) -> Array:
    """The controls at the end of a stage."""
    part = recorded[number]
    solver = stiv.EditSession(
        part.stage.surface, part.stage.deformation, part.tasks[-1].start,
        stiv.EditOptions(threads=1, **part.stage.options),
    )  # fmt: skip
    return solver.edit(part.tasks[-1].goal).controls


def _index(part: RecordedStage, name: str) -> int:
    return [body.name for body in part.stage.surface.bodies].index(name)


def _triangles(part: RecordedStage, mine: Any) -> Any:
    triangles = part.stage.surface.triangles
    return np.cumsum(mine)[triangles[mine[triangles].all(axis=1)]] - 1


def cloth_text(rows: list[dict[str, Any]]) -> str:
    """A line per stage, with the ratios first."""
    lines = [
        f"{'Model':18} {'kept, ratio':>11} {'time, ratio':>11} {'kept':>7} {'cloth':>7} {'ms/edit':>8} "
        f"{'ms/frame':>8} {'left':>5} {'cloth':>6}"
    ]
    for r in rows:
        ratio = f"{r['kept'] / r['kept_by_cloth']:.2f}" if r["kept_by_cloth"] > 0 else "-"
        lines.append(
            f"{r['scene']:18} {ratio:>11} "
            f"{r['processor_ms_per_edit'] / r['processor_ms_per_frame']:11.2f} {r['kept']:7.3f} "
            f"{r['kept_by_cloth']:7.3f} {r['processor_ms_per_edit']:8.1f} {r['processor_ms_per_frame']:8.1f} "
            f"{r['intersections']:5d} {r['intersections_by_cloth']:6d}"
        )
    return "\n".join(lines)
