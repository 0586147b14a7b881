# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of whole sessions: frames per second, drags as a user sees them, growth, and large scenes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmarks.results_tables.markdown import SCENES, loaded, markdown, number
from benchmarks.sessions.dragged_profile import DragFigures, drag_figures
from benchmarks.sessions.profile import frame_rates

LEAST_RATES = {"hare": 12}
"""Frames per second that a scene has to keep, where that is not 24."""


def frames() -> str:
    """Frames per second of the core and in Blender."""
    core = {(row["scene"], row["threads"]): row for row in loaded("profile")["rows"]}
    blender = {row["scene"]: row for row in loaded("profile_in_blender")["rows"]}
    lines = []
    for scene in SCENES:
        rate, shown = LEAST_RATES.get(scene, 24), blender[scene]
        lines.append(
            [
                scene if rate == 24 else f"{scene} (below {rate})",
                _rates(core[scene, 1]["seconds"]),
                _rates(core[scene, 2]["seconds"]),
                _below(core[scene, 1]["seconds"], rate),
                _rates(shown["seconds"]),
                _below(shown["seconds"], rate),
                f"{1000 * np.mean(shown['evaluation']):.1f}",
            ]
        )
    head = [
        "scene",
        "core: least, median, mean",
        "with two threads",
        "frames below 24",
        "in Blender: least, median, mean",
        "frames below 24",
        "Blender's evaluation, ms per frame",
    ]
    return markdown(head, lines)


def _rates(seconds: Sequence[float]) -> str:
    return ", ".join(f"{rate:.0f}" for rate in frame_rates(seconds))


def _below(seconds: Sequence[float], rate: float) -> str:
    return f"{np.count_nonzero(np.array(seconds) > 1 / rate)} of {len(seconds)}"


def frame_shares() -> str:
    """How the time of the frames in Blender divides, in percent."""
    parts = ("modeling", "detection", "response", "acceptance", "evaluation", "writing", "other")
    blender = {row["scene"]: row["shares"] for row in loaded("profile_in_blender")["rows"]}
    lines = [[scene, *(_percent(blender[scene][part]) for part in parts)] for scene in SCENES]
    head = ["scene", *parts[:4], "Blender's evaluation", "writing, reading back, exact test", "rest"]
    return markdown(head, lines)


def _percent(share: float) -> str:
    return f"{100 * share:.0f}" if share >= 0.05 else f"{100 * share:.1f}"


def drags() -> str:
    """Drags in Blender, as a user sees them."""
    blender = {row["scene"]: row["dragged"] for row in loaded("profile_in_blender")["rows"]}
    lines = [
        [f"{scene}, {part['threads']}", *_drag(drag_figures(part["stages"]))]
        for scene in SCENES
        for part in blender[scene]
    ]
    head = [
        "scene, threads",
        "shapes a second",
        "missed",
        "ticks",
        "between updates, mouse moving",
        "behind the mouse",
        "settled after",
        "Enter",
    ]
    return markdown(head, lines)


def _drag(figures: DragFigures) -> list[str]:
    return [
        f"{figures.least:.0f}, {figures.mean:.0f}, {figures.median:.0f}",
        str(figures.missed),
        figures.ticks,
        figures.apart,
        figures.behind,
        f"{figures.settling:.0f}",
        f"{figures.confirming:.0f}",
    ]


def growth() -> str:
    """Edits with contacts on one thread, by the number of triangles."""
    lines = [
        [
            f"{row['triangles']:,}",
            number(row["processor_ms_per_edit"]),
            f"{row['iterations']:.1f}",
            number(row["processor_ms_per_iteration"]),
        ]
        for row in loaded("scaling")["rows"]
        if row["threads"] == 1
    ]
    return markdown(["triangles", "ms per edit", "rounds", "ms per round"], lines)


def large_scenes() -> str:
    """A drag over a large landscape."""
    lines = [
        [
            f"{row['static_triangles']:,}",
            "obstacle" if row["scene"].endswith("obstacle") else "fixed body",
            str(row["threads"]),
            *(number(row[what]) for what in ("first_tick_ms", "clock_ms_median", "clock_ms_95", "clock_ms_max")),
            f"{row['memory_mb']:.0f}",
            f"{row['bytes_per_static_triangle']:.0f}",
        ]
        for row in loaded("large_scene")["rows"]
    ]
    head = [
        "static triangles",
        "given as",
        "threads",
        "first tick, ms",
        "median, ms",
        "95 %, ms",
        "longest, ms",
        "memory, MB",
        "bytes per static triangle",
    ]
    return markdown(head, lines)


def long_sessions() -> str:
    """Growth of memory in long sessions, by the seed of their random drags."""
    lines = [
        [
            str(row["seed"]),
            f"{row['drags_between']:,}",
            *(f"{row['memory'][0][kind] / 1e6:.1f} MB, {100 * row['growth'][kind]:+.2f} %" for kind in row["growth"]),
        ]
        for row in loaded("long_sessions")["rows"]
    ]
    return markdown(["seed", "drags", "resident", "without free pages", "allocated"], lines)


def cloth() -> str:
    """Two stages of the dressing beside Blender's cloth simulation."""
    names = {"dressing, expand": "body grows", "dressing, shrink": "shirt shrinks"}
    lines = [
        [
            names[row["scene"]],
            f"{row['processor_ms_per_edit'] / row['processor_ms_per_frame']:.2f}",
            f"{row['kept']:.3f}, {row['kept_by_cloth']:.3f}",
            f"{row['intersections']}, {row['intersections_by_cloth']}",
            f"{number(row['processor_ms_per_edit'])}, {number(row['processor_ms_per_frame'])}",
        ]
        for row in loaded("cloth")["rows"]
    ]
    head = [
        "stage",
        "time, ours / cloth",
        "achieved: ours, cloth",
        "intersecting pairs left: ours, cloth",
        "ms: per edit, per frame",
    ]
    return markdown(head, lines)


def models() -> str:
    """Edits of the models by others, on one thread and two."""
    rows = {(row["scene"], row["threads"]): row for row in loaded("models")["rows"]}
    lines = []
    for scene, name in (("bunny", "bunny in teapot"), ("ogre", "ogre dressed")):
        one, two = rows[scene, 1], rows[scene, 2]
        lines.append(
            [
                name,
                *(f"{one[what]:,}" for what in ("vertices", "triangles", "edits")),
                number(one["collisions"]),
                f"{one['iterations']:.1f}",
                *(f"{number(one[what])} ({number(two[what])})" for what in ("ms_per_iteration", "ms_per_edit")),
                str(one["intersections"] + two["intersections"]),
            ]
        )
    head = [
        "scene",
        "vertices",
        "triangles",
        "edits",
        "contacts per round",
        "rounds",
        "ms per round (two threads)",
        "ms per edit (two threads)",
        "intersections",
    ]
    return markdown(head, lines)
