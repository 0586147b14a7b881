# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares edits of the table's sessions with a stop at the first contact that ipctk finds.

ipctk [Ferguson et al. 2020] has a broad phase with linear BVHs and additive continuous detection; it must
be installed. Both methods start from the same accepted states. The fraction of the motion to the goal that
is reached is 1 - |q - q~| / |q0 - q~|.

The second comparison is our own loop with ipctk's detection. It reaches the same states as ours, and its
time is that of our edit with each detection at the time of ipctk for the whole step. This favors ipctk,
because it only finds the earliest time.

ipctk runs on the whole mesh, and culled to moving vertices and those near their motion (peer_mesh.py). The
table uses the faster of both for each edit, without the time of culling and of ipctk's mesh.
"""

from __future__ import annotations

import importlib
import time
from collections.abc import Sequence
from types import ModuleType
from typing import Any

import numpy as np

import stiv
from benchmarks.sessions.peer_mesh import LinearStep, peer_mesh
from benchmarks.sessions.running import EditFigures, RecordedStage, Report, record
from blend_fixtures.scenes.sessions import catalogue
from stiv import InputError


def race(names: Sequence[str], report: Report) -> list[dict[str, Any]]:
    """One row per scene, over the edits with contacts, on one thread. Raises InputError if ipctk is missing."""
    peer = _ipctk()
    sessions = catalogue.table_sessions()
    rows = []
    for name in names:
        recorded, figures = record(sessions[name], {"threads": 1}, lambda note: None)
        stopped = [answer for part in recorded for answer in _first_contacts(peer, part)]
        both = [(mine, theirs) for mine, theirs in zip(figures, stopped, strict=True) if mine.touches]
        kept = [1 - np.sqrt(2 * mine.energy) / theirs["wanted"] for mine, theirs in both]
        report(name)
        rows.append(
            {
                "scene": name,
                "edits_with_contacts": len(both),
                "kept": float(np.mean(kept)),
                "kept_by_stopping": float(np.mean([theirs["fraction"] for _, theirs in both])),
                "processor_ms_per_edit": 1000 * float(np.mean([mine.processor for mine, _ in both])),
                "processor_ms_with_its_detection": 1000
                * float(np.mean([with_detection(mine, theirs["processor"]) for mine, theirs in both])),
                "processor_ms_per_stop": 1000 * float(np.mean([theirs["processor"] for _, theirs in both])),
                "processor_ms_per_stop_of_everything": 1000
                * float(np.mean([theirs["processor_everything"] for _, theirs in both])),
                "intersections": sum(mine.intersections for mine in figures),
                "intersections_by_stopping": sum(theirs["intersections"] for theirs in stopped),
            }
        )
    return rows


def with_detection(mine: EditFigures, seconds: float) -> float:
    """Seconds of an edit if each of its detections took this many seconds."""
    own_share = mine.timings["detection"] / max(mine.timings["total"], 1e-300)
    return mine.processor * (1 - own_share) + mine.detections * seconds


def _ipctk() -> ModuleType:
    try:
        peer = importlib.import_module("ipctk")
    except ImportError as error:
        raise InputError("bench race: ipctk is not installed (pip install ipctk)") from error
    peer.set_num_threads(1)
    peer.set_logger_level(peer.off)
    return peer


def _first_contacts(peer: ModuleType, part: RecordedStage) -> list[dict[str, float]]:
    """Stops each edit of a stage before its first contact: the fraction of the motion, time and intersections."""
    stage = part.stage
    answers = []
    for task in part.tasks:
        before, wanted = (stage.deformation.surface(p) for p in (task.start, task.goal))
        step = LinearStep(stage.surface.triangles, before, wanted)
        fraction, everything = _free_fraction(peer, step, "everything")
        processor = min(everything, _free_fraction(peer, step, "culled")[1])
        reached = stage.deformation.surface(task.start + fraction * (task.goal - task.start))
        pairs = len(stiv.find_intersections(reached, stage.surface))
        distance = float(np.linalg.norm(wanted - before))
        answers.append(
            {
                "fraction": fraction,
                "processor": processor,
                "processor_everything": everything,
                "intersections": pairs,
                "wanted": max(distance, 1e-300),
            }
        )
    return answers


def _free_fraction(peer: ModuleType, step: LinearStep, setting: str) -> tuple[float, float]:
    """The fraction of a step before the first contact, and the seconds of the computation in this thread.

    Those of the process would include threads of NumPy's BLAS, which spin for a while after they were used.
    """
    given = peer_mesh(peer, step, setting)
    begin = time.thread_time()
    candidates = peer.Candidates()
    candidates.build(given.mesh, given.start, given.end, 0, peer.LBVH())
    free: float = candidates.compute_collision_free_stepsize(given.mesh, given.start, given.end, 0, peer.AdditiveCCD())
    return free, time.thread_time() - begin


def race_text(rows: Sequence[dict[str, Any]]) -> str:
    """A line per scene, with the ratios first."""
    lines = [
        f"{'Model':9} {'kept, ratio':>11} {'time, ratio':>11} {'ratio in loop':>13} {'kept':>7} {'stopping':>8} "
        f"{'ms/edit':>8} {'ms/stop':>8} {'ms/all':>8} {'ms in loop':>10} {'left':>5} {'stopping':>8}"
    ]
    for r in rows:
        kept = r["kept"] / max(r["kept_by_stopping"], 1e-9)
        slower = r["processor_ms_per_edit"] / r["processor_ms_per_stop"]
        in_loop = r["processor_ms_with_its_detection"]
        lines.append(
            f"{r['scene']:9} {kept:11.2f} {slower:11.2f} {r['processor_ms_per_edit'] / in_loop:13.3f} {r['kept']:7.3f} "
            f"{r['kept_by_stopping']:8.3f} {r['processor_ms_per_edit']:8.1f} {r['processor_ms_per_stop']:8.1f} "
            f"{r['processor_ms_per_stop_of_everything']:8.1f} "
            f"{in_loop:10.1f} {r['intersections']:5d} {r['intersections_by_stopping']:8d}"
        )
    return "\n".join(lines)
