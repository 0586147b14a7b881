# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares edits, settled and tight ones, drags and confirmed drags with converged interior-point solutions."""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import stiv
from benchmarks.quality.cases import cases
from benchmarks.sessions.running import Report
from blend_fixtures.scenes.families import Edit
from stiv import InputError

Array = NDArray[np.float64]
WAYS = ("stop", "edit", "settled", "tight", "drag", "confirmed", "in Blender", "ipc")
DRAG_STEPS = 20
SETTLE_CALLS = 12  #: at most
BUDGET = 1e6  #: seconds of a call: ends nothing, but calls with a budget take no long ways
NEGLIGIBLE = 1e-9  #: of the energy at the start; below it, an edit reached its goal
SMALLEST = 1e-60  #: coordinates below it are rounding errors of the solver, which the exact test refuses
QUANTILE = 0.99  #: of the growth of edges


def quality(
    folder: Path, names: Sequence[str], seconds: float, report: Report
) -> tuple[list[dict[str, Any]], dict[str, dict[str, Array]]]:
    """One row per edit and way, and the surfaces by edit and way.

    folder   holds the models
    names    of edits; empty: all
    seconds  of the processor, the limit of one interior-point solution

    Raises InputError without ipctk, the models, or an edit of that name.
    """
    try:
        interior_point = importlib.import_module("benchmarks.interior_point")
        ipctk = importlib.import_module("ipctk")
    except ModuleNotFoundError as error:
        raise InputError(f"bench quality needs {error.name}: pip install -r tools/requirements/bench.txt") from error
    known = cases(folder)
    unknown = [name for name in names if name not in known]
    if unknown:
        raise InputError(f"bench quality: there is no edit {', '.join(unknown)}; there are {', '.join(known)}")
    rows: list[dict[str, Any]] = []
    surfaces: dict[str, dict[str, Array]] = {}
    for name in names or known:
        edit = known[name]()
        found = _by_stiv(edit)
        separation = interior_point.separation_of(edit)
        optimum = interior_point.InteriorPoint(ipctk, edit, separation, seconds).solve(edit.controls)
        surface = edit.deformation.surface(optimum.controls)
        surface = np.where(abs(surface) < SMALLEST, 0, surface)
        found["ipc"] = (surface, optimum.seconds, optimum.converged)
        rows += [_row(edit, way, *found[way]) for way in WAYS]
        surfaces[name] = {way: surface for way, (surface, _, _) in found.items()}
        report(f"{name}: kept " + ", ".join(f"{row['way']} {row['kept']:.3f}" for row in rows[-len(WAYS) :]))
    return rows, surfaces


_Found = tuple[Array, float, bool]  # surface, seconds, whether the solver converged


def _by_stiv(edit: Edit) -> dict[str, _Found]:
    def session(**chosen: Any) -> stiv.EditSession:
        options = stiv.EditOptions(**{"threads": 1, **edit.options, **chosen})
        return stiv.EditSession(edit.surface, edit.deformation, edit.controls, options)

    def timed(session: stiv.EditSession, work: Callable[[], object]) -> _Found:
        began = time.process_time()
        work()
        return np.array(session.surface), time.process_time() - began, True

    edited, tightened, dragged, limited = session(), session(tight=True), session(), session(time_budget=BUDGET)
    found = {"stop": (_stop(session(), edit), 0.0, True)}
    found["edit"] = timed(edited, lambda: edited.edit(edit.goal))
    surface, seconds, _ = timed(edited, lambda: _settle(edited))
    found["settled"] = surface, seconds + found["edit"][1], True
    found["tight"] = timed(tightened, lambda: tightened.edit(edit.goal))
    goals = edit.controls + (edit.goal - edit.controls) * np.arange(1, DRAG_STEPS + 1)[:, None, None] / DRAG_STEPS
    found["drag"] = timed(dragged, lambda: [dragged.drag(goal) for goal in goals])
    surface, seconds, _ = timed(dragged, dragged.settle)
    found["confirmed"] = surface, seconds + found["drag"][1], True
    found["in Blender"] = timed(limited, lambda: _drag_as_blender(limited, goals))
    return found


def _drag_as_blender(session: stiv.EditSession, goals: Array) -> None:
    for goal in goals:
        session.drag(goal)
    session.settle()
    session.confirm()


def _settle(session: stiv.EditSession) -> None:
    for _ in range(SETTLE_CALLS):
        if session.settle().status == "unchanged":
            return


def _stop(session: stiv.EditSession, edit: Edit) -> Array:
    """The last of 64 equal steps toward the goal before the first contact."""
    start = np.array(session.surface)
    surface = start
    for fraction in np.arange(1, 65) / 64:
        ahead = edit.deformation.surface(edit.controls + fraction * (edit.goal - edit.controls))
        if not session.is_step_free(surface, ahead):
            break
        surface = ahead
    return surface


def _row(edit: Edit, way: str, surface: Array, seconds: float, converged: bool) -> dict[str, Any]:
    start, goal = edit.deformation.surface(edit.controls), edit.deformation.surface(edit.goal)
    missing, motion = np.linalg.norm(surface - goal), np.linalg.norm(start - goal)
    return {
        "edit": edit.name,
        "way": way,
        "energy": 0.5 * float(missing**2),
        "reached": bool(missing**2 < NEGLIGIBLE * motion**2),
        "kept": float(1 - missing / motion),
        "stretch": _stretch(edit, start, surface, np.any(start != goal, axis=1)),
        "seconds": seconds,
        "converged": converged,
        "intersections": len(stiv.find_intersections(surface, edit.surface)),
    }


def _stretch(edit: Edit, start: Array, surface: Array, moves: NDArray[np.bool_]) -> float:
    """The growth that 99 % of the moving edges do not exceed."""
    triangles = edit.surface.triangles
    edges = np.unique(np.sort(np.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])), axis=0)
    edges = edges[moves[edges].any(axis=1)]
    before, after = (np.linalg.norm(q[edges[:, 0]] - q[edges[:, 1]], axis=1) for q in (start, surface))
    return float(np.quantile(after / before, QUANTILE))


def energy_ratios(rows: Sequence[dict[str, Any]], way: str) -> dict[str, float]:
    """The energy of a way relative to the interior-point solution, where neither reached the goal."""
    by_edit: dict[str, dict[str, dict[str, Any]]] = {}
    for row in rows:
        by_edit.setdefault(row["edit"], {})[row["way"]] = row
    return {
        name: ways[way]["energy"] / ways["ipc"]["energy"]
        for name, ways in by_edit.items()
        if not ways[way]["reached"] and not ways["ipc"]["reached"]
    }


def quality_text(rows: Sequence[dict[str, Any]]) -> str:
    """Tables of the share of the motion kept by edit and way, and of the means."""
    names = list(dict.fromkeys(row["edit"] for row in rows))
    lines = ["share of the motion kept".ljust(26) + "".join(way.rjust(10) for way in WAYS)]
    for name in names:
        kept = {row["way"]: row["kept"] for row in rows if row["edit"] == name}
        lines.append(name.ljust(26) + "".join(f"{kept[way]:10.3f}" for way in WAYS))
    for label, field in (("mean kept", "kept"), ("mean stretch, 99 %", "stretch"), ("seconds", "seconds")):
        means = [np.mean([row[field] for row in rows if row["way"] == way]) for way in WAYS]
        lines.append(label.ljust(26) + "".join(f"{mean:10.3f}" for mean in means))
    ratios = [list(energy_ratios(rows, way).values()) for way in WAYS]
    means = [float(np.exp(np.mean(np.log(values)))) if values else float("nan") for values in ratios]
    lines.append("energy over ipc, geometric".ljust(26) + "".join(f"{mean:10.3f}" for mean in means))
    return "\n".join(lines)
