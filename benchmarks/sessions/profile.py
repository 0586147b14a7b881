# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames per second over a session, edit by edit, as in the paper's Figure 12, and the split of the time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from benchmarks.sessions.running import Report, record
from benchmarks.sessions.table1 import shares
from blend_fixtures.scenes.sessions import catalogue


def profile(names: Sequence[str], threads: Sequence[int], report: Report) -> list[dict[str, Any]]:
    """One row per scene and number of threads, with the seconds of each edit in order."""
    sessions = catalogue.figure_sessions()
    rows = []
    for name in names:
        for count in threads:
            _, figures = record(sessions[name], {"threads": count}, lambda note: None)
            seconds = [figure.processor if count == 1 else figure.clock for figure in figures]
            report(name)
            rows.append(
                {
                    "scene": name,
                    "threads": count,
                    "time": "processor" if count == 1 else "clock",
                    "stages": [figure.stage for figure in figures],
                    "seconds": seconds,
                    "touches": [figure.touches for figure in figures],
                    "shares": shares(figures),
                    "intersections": sum(figure.intersections for figure in figures),
                }
            )
    return rows


def frame_rates(seconds: Sequence[float]) -> tuple[float, float, float]:
    """Frames per second: minimum, median, and mean over the whole time."""
    rates = 1 / np.array(seconds)
    return float(rates.min()), float(np.median(rates)), len(seconds) / sum(seconds)


def profile_text(rows: Sequence[dict[str, Any]]) -> str:
    """A line per row: minimum, median and mean of frames per second, and the split of the time."""
    parts = tuple(rows[0]["shares"])
    lines = [
        f"{'Model':9} {'threads':>7} {'least':>6} {'median':>6} {'mean':>6}  " + " ".join(f"{p:>10}" for p in parts)
    ]
    for r in rows:
        rates = " ".join(f"{rate:6.1f}" for rate in frame_rates(r["seconds"]))
        split = " ".join(f"{100 * r['shares'][part]:9.1f}%" for part in parts)
        lines.append(f"{r['scene']:9} {r['threads']:7d} {rates}  {split}")
    return "\n".join(lines)
