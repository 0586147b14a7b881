# SPDX-License-Identifier: GPL-3.0-or-later
"""Growth of the time of an edit with the number of triangles: a body is scaled up inside a shell."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from benchmarks.sessions.running import Report, record
from blend_fixtures.scenes.sessions.growth import growth_sessions


def scaling(threads: Sequence[int], largest: int, report: Report) -> list[dict[str, Any]]:
    """One row per size: mean times of the edits with contacts, which are the same at each size."""
    rows = []
    for session in growth_sessions(largest):
        for count in threads:
            recorded, figures = record(session, {"threads": count}, lambda note: None)
            touching = [figure for figure in figures if figure.touches]
            surface = recorded[0].stage.surface
            report(session.name)
            rows.append(
                {
                    "scene": session.name,
                    "threads": count,
                    "vertices": surface.vertex_count,
                    "triangles": len(surface.triangles),
                    "edits_with_contacts": len(touching),
                    "iterations": float(np.mean([f.iterations for f in touching])),
                    "processor_ms_per_edit": 1000 * float(np.mean([f.processor for f in touching])),
                    "clock_ms_per_edit": 1000 * float(np.mean([f.clock for f in touching])),
                    "processor_ms_per_iteration": 1000
                    * sum(f.processor for f in touching)
                    / sum(f.iterations for f in touching),
                    "intersections": sum(figure.intersections for figure in figures),
                }
            )
    return rows


def exponent(rows: Sequence[dict[str, Any]], what: str) -> float:
    """The exponent of the growth of a time with the number of triangles, fitted to all sizes."""
    sizes, times = np.log([row["triangles"] for row in rows]), np.log([row[what] for row in rows])
    return float(np.polyfit(sizes, times, 1)[0])


def scaling_text(rows: Sequence[dict[str, Any]]) -> str:
    """A line per size, and the exponents."""
    lines = [f"{'triangles':>10} {'threads':>7} {'iterations':>10} {'processor ms/edit':>18} {'ms/iteration':>13}"]
    for r in rows:
        lines.append(
            f"{r['triangles']:10d} {r['threads']:7d} {r['iterations']:10.2f} {r['processor_ms_per_edit']:18.1f} "
            f"{r['processor_ms_per_iteration']:13.1f}"
        )
    for count in dict.fromkeys(row["threads"] for row in rows):
        of = [row for row in rows if row["threads"] == count]
        powers = [exponent(of, f"processor_ms_per_{unit}") for unit in ("edit", "iteration")]
        if len(of) > 1:
            lines.append(
                f"{count} thread(s): time an edit grows as triangles^{powers[0]:.2f}, an iteration ^{powers[1]:.2f}"
            )
    return "\n".join(lines)
