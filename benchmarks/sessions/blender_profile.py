# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames per second of sessions in Blender, with its evaluation, and the split of the time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import blend_fixtures
from benchmarks.sessions.dragged_profile import DragsOf, dragged_rows
from benchmarks.sessions.running import Report
from benchmarks.sessions.table1 import PARTS
from stiv import InputError

FIXTURES = Path(blend_fixtures.__file__).parent
FILES = {
    "plant": "plant_in_vase",
    "hare": "figures/hare_in_pot",
    "tree": "figures/tree_in_corner",
    "knot": "figures/knot_by_handles",
    "dressing": "figures/dressing",
}


def blender_profile(
    names: Sequence[str],
    frames_of: Callable[[Path], Sequence[Any]],
    drags_of: DragsOf,
    threads: Sequence[int],
    report: Report,
) -> list[dict[str, Any]]:
    """One row per scene, in wall time. Raises InputError if a .blend file is missing.

    Frames use one thread and are solved completely. "dragged" are the same drags as a user sees them, for
    each number of threads (see `dragged_rows`). frames_of: opens a .blend, runs its script and returns the
    `FrameTime` of each frame.
    """
    rows = []
    for name in names:
        path = FIXTURES / f"{FILES[name]}.blend"
        if not path.is_file():
            raise InputError(f"bench profile --in-blender: there is no {path.name}; run it in a source checkout")
        frames = frames_of(path)
        report(name)
        dragged, failed = dragged_rows(path, drags_of, threads)
        report(f"{name}, as dragged")
        total = sum(frame.seconds for frame in frames)
        rows.append(
            {
                "scene": name,
                "threads": 1,
                "time": "clock",
                "in_blender": True,
                "stages": [frame.stage for frame in frames],
                "seconds": [frame.seconds for frame in frames],
                "evaluation": [frame.evaluation for frame in frames],
                "touches": [frame.touches for frame in frames],
                "shares": shares_with_blender(frames, total),
                "intersections": sum(not frame.passed for frame in frames) + failed,
                "dragged": dragged,
            }
        )
    return rows


def shares_with_blender(frames: Sequence[Any], total: float) -> dict[str, float]:
    """Fractions of the total time: stages of the pipeline, Blender's evaluation, the rest of writing, the
    rest.

    The timings of the core are scaled to the time of solving, which includes the calls of the core.
    """
    parts = dict.fromkeys((*PARTS, "evaluation", "writing"), 0.0)
    for frame in frames:
        solving = frame.seconds - frame.evaluation - frame.writing
        whole = frame.solved.get("total", 0.0)
        for part, timers in PARTS.items():
            parts[part] += solving * sum(frame.solved.get(timer, 0.0) for timer in timers) / whole if whole else 0.0
        parts["evaluation"] += frame.evaluation
        parts["writing"] += frame.writing
    shares = {part: seconds / (total or 1.0) for part, seconds in parts.items()}
    return {**shares, "other": 1 - sum(shares.values())}
