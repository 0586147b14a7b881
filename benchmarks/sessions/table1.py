# SPDX-License-Identifier: GPL-3.0-or-later
"""Table 1 of the paper: the method as published and ours, next to the printed figures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

import stiv
from benchmarks.sessions.running import EditFigures, Preset, RecordedStage, Report, record, repeat
from blend_fixtures.scenes.sessions import catalogue

# : Vertices, triangles, collisions, regions, iterations and total ms with many constraints and with one. [Table 1]
PUBLISHED: dict[str, dict[str, Any]] = {
    "plant": {"vertices": 13759, "triangles": 26782, "collisions": 36.21, "regions": 4.07,
              "iterations": (1.56, 2.20), "ms_per_edit": (75.52, 89.31)},
    "hare": {"vertices": 38045, "triangles": 75943, "collisions": 46.33, "regions": 1.42,
             "iterations": (1.08, 1.75), "ms_per_edit": (678.7, 917.0)},
    "tree": {"vertices": 32937, "triangles": 18745, "collisions": 16.16, "regions": 2.49,
             "iterations": (2.21, 2.64), "ms_per_edit": (125.0, 150.2)},
    "knot": {"vertices": 5808, "triangles": 11616, "collisions": 23.25, "regions": 1.83,
             "iterations": (2.30, 2.16), "ms_per_edit": (150.0, 124.0)},
    "dressing": {"vertices": 13318, "triangles": 26060, "collisions": 50.14, "regions": 2.60,
                 "iterations": (8.59, 11.8), "ms_per_edit": (316.4, 326.0)},
}  # fmt: skip
PRESETS: dict[str, Preset] = {
    "stiv": stiv.EditOptions,
    "paper": stiv.EditOptions.paper,
    "paper_frozen": stiv.EditOptions.paper_frozen,
}
NAMES = {"stiv": "ours", "paper": "its method here", "paper_frozen": "its gradient frozen"}
KINDS = {"many": "per_patch", "one": "single"}
PARTS = {
    "modeling": ("deformation",),
    "detection": ("detection",),
    "response": ("volumes", "response"),
    "acceptance": ("acceptance",),
}


def table1(
    names: Sequence[str], threads: Sequence[int], report: Report, kinds: Sequence[str] = tuple(KINDS)
) -> list[dict[str, Any]]:
    """One row per scene, preset, kind of constraint and number of threads, without the printed figures.

    kinds: of KINDS; the defaults always include "many". The edits are recorded with our defaults. Every
    other row repeats the same edits from the same accepted states, so that energies can be compared.
    """
    sessions = catalogue.table_sessions()
    rows = []
    for name in names:
        recorded, ours = record(sessions[name], {"threads": threads[0]}, report)
        rows.append(row(name, "stiv", "many", threads[0], recorded, ours, ours))
        for preset, kind, count in variants(threads, kinds):
            figures = repeat(recorded, PRESETS[preset], {"threads": count, "constraints": KINDS[kind]})
            report(f"{name}: {preset}, {kind} constraint(s), {count} thread(s)")
            rows.append(row(name, preset, kind, count, recorded, figures, ours))
    return rows


def variants(threads: Sequence[int], kinds: Sequence[str]) -> list[tuple[str, str, int]]:
    """Preset, kind of constraint and threads of all rows except the first."""
    others = [("stiv", "one"), ("paper", "many"), ("paper", "one"), ("paper_frozen", "many")]
    first = [(preset, kind, threads[0]) for preset, kind in others if kind in kinds]
    return first + [("stiv", "many", count) for count in threads[1:]]


def row(
    name: str,
    preset: str,
    kind: str,
    threads: int,
    recorded: Sequence[RecordedStage],
    figures: Sequence[EditFigures],
    ours: Sequence[EditFigures],
) -> dict[str, Any]:
    """Averages over the edits with contacts; energies over the edits with contacts in our method."""
    touching = [figure for figure in figures if figure.touches]
    surface = recorded[0].stage.surface

    def mean(values: list[float]) -> float:
        return float(np.mean(values)) if values else 0.0

    iterations = mean([figure.iterations for figure in touching])
    # with several threads, processor time differs from waiting time
    processor, clock = (1000 * mean([getattr(f, what) for f in touching]) for what in ("processor", "clock"))
    ms = processor if threads == 1 else clock
    return {
        "scene": name,
        "preset": preset,
        "constraints": kind,
        "threads": threads,
        "vertices": surface.vertex_count,
        "triangles": len(surface.triangles),
        "edits": len(figures),
        "edits_with_contacts": len(touching),
        "step": mean([figure.step for figure in touching]),
        "collisions": mean([figure.collisions for figure in touching]),
        "regions": mean([figure.regions for figure in touching]),
        "iterations": iterations,
        "ms_per_iteration": ms / max(iterations, 1e-9),
        "ms_per_edit": ms,
        "time": "processor" if threads == 1 else "clock",
        "processor_ms_per_edit": processor,
        "clock_ms_per_edit": clock,
        "energy": mean([f.energy for f, of_ours in zip(figures, ours, strict=True) if of_ours.touches]),
        "blocked": sum(figure.status == "blocked" for figure in figures),
        "intersections": sum(figure.intersections for figure in figures),
        "shares": shares(touching),
    }


def shares(figures: Sequence[EditFigures]) -> dict[str, float]:
    """Fractions of the time: stages of the pipeline, and the rest."""
    total = sum(figure.timings["total"] for figure in figures) or 1.0
    parts = {part: sum(f.timings[timer] for f in figures for timer in timers) / total for part, timers in PARTS.items()}
    return {**parts, "other": 1 - sum(parts.values())}


def table_text(rows: Sequence[dict[str, Any]]) -> str:
    """The table in the layout of the paper: a line each for the printed figures, its method, and ours."""
    head = (
        f"{'Model':9} {'by':32} {'Vertices':>8} {'Triangles':>9} {'step':>7} {'Collisions':>10} {'Regions':>7} "
        f"{'Iterations':>13} {'ms/iteration':>15} {'ms/edit':>15} {'energy':>9} {'left':>5}"
    )
    lines = [head, "-" * len(head)]
    for scene in dict.fromkeys(row["scene"] for row in rows):
        lines.append(_published_line(scene))
        for preset in ("paper", "paper_frozen", "stiv"):
            of = [row for row in rows if row["scene"] == scene and row["preset"] == preset]
            for threads in dict.fromkeys(row["threads"] for row in of):
                lines.append(_line(scene, preset, {r["constraints"]: r for r in of if r["threads"] == threads}, rows))
    return "\n".join(lines)


def _published_line(scene: str) -> str:
    values = PUBLISHED[scene]
    each = tuple(ms / n for ms, n in zip(values["ms_per_edit"], values["iterations"], strict=True))
    return (
        f"{scene:9} {'paper, i5 3.6 GHz, 1 thread':32} {values['vertices']:8d} {values['triangles']:9d} "
        f"{'':7} {values['collisions']:10.2f} {values['regions']:7.2f} {_pair(values['iterations']):>13} "
        f"{_pair(each):>15} {_pair(values['ms_per_edit']):>15} {'':>9} {'':>5}"
    )


def _line(scene: str, preset: str, kinds: dict[str, dict[str, Any]], rows: Sequence[dict[str, Any]]) -> str:
    first = kinds.get("many") or kinds["one"]
    both = [kinds[kind] for kind in ("many", "one") if kind in kinds]
    baseline = next((r for r in rows if (r["scene"], r["preset"], r["constraints"]) == (scene, "paper", "many")), first)
    name = f"{NAMES[preset]}, {first['threads']} thr., {first['time'][:5]}"
    return (
        f"{'':9} {name:32} {first['vertices']:8d} {first['triangles']:9d} {100 * first['step']:6.2f}% "
        f"{first['collisions']:10.2f} "
        f"{first['regions']:7.2f} {_pair(r['iterations'] for r in both):>13} "
        f"{_pair(r['ms_per_iteration'] for r in both):>15} {_pair(r['ms_per_edit'] for r in both):>15} "
        f"{first['energy'] / (baseline['energy'] or 1):9.3f} {sum(r['intersections'] for r in both):5d}"
    )


def _pair(values: Any) -> str:
    return " / ".join(f"{value:.3g}" if value < 100 else f"{value:.0f}" for value in values)


def shares_text(rows: Sequence[dict[str, Any]]) -> str:
    """The split of the time. In the paper, interface, modeling, detection and response have 15, 15, 51 and 16
    %.
    """
    lines = [
        f"{'Model':9} {'by':6} {'constraints':11} {'threads':>7} " + " ".join(f"{p:>10}" for p in (*PARTS, "other"))
    ]
    for r in rows:
        parts = " ".join(f"{100 * r['shares'][part]:9.1f}%" for part in (*PARTS, "other"))
        lines.append(f"{r['scene']:9} {r['preset']:6} {r['constraints']:11} {r['threads']:7d} {parts}")
    return "\n".join(lines)
