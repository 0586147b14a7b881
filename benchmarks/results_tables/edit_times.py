# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of edits and detection on their own, with the programs that they are compared with."""

from __future__ import annotations

from typing import Any

from benchmarks.results_tables.markdown import SCENES, loaded, markdown, number
from benchmarks.sessions.table1 import PUBLISHED


def _pairs(rows: dict[tuple[str, str, int], Any], preset: str, what: str) -> str:
    return " / ".join(number(rows[preset, kind, 1][what]) for kind in ("many", "one"))


def table1() -> str:
    """Step sizes, contacts, energies and times of the sessions of Table 1."""
    lines = []
    for scene in SCENES:
        rows = {
            (r["preset"], r["constraints"], r["threads"]): r for r in loaded("table1")["rows"] if r["scene"] == scene
        }
        ours, paper, frozen = (rows[preset, "many", 1] for preset in ("stiv", "paper", "paper_frozen"))
        published = PUBLISHED[scene]
        ratios = [rows["stiv", kind, 1]["energy"] / rows["paper", kind, 1]["energy"] for kind in ("many", "one")]
        two = rows.get(("stiv", "many", 2))
        lines.append(
            [
                scene,
                f"{100 * ours['step']:.2f} %",
                f"{published['collisions']:.0f} / {number(ours['collisions'])}",
                " / ".join(f"{ratio:.2f}" for ratio in ratios),
                f"{ours['energy'] / frozen['energy']:.2f}",
                f"{ours['blocked']} / {paper['blocked']}",
                _pairs(rows, "stiv", "ms_per_edit"),
                number(two["ms_per_edit"]) if two else "",
                _pairs(rows, "paper", "ms_per_edit"),
                " / ".join(number(ms) for ms in published["ms_per_edit"]),
            ]
        )
    head = [
        "scene",
        "step",
        "contacts per round, paper / ours",
        "energy, ours / paper's method",
        "ours / its frozen gradient",
        "blocked, ours / paper's method",
        "ours, ms per edit",
        "two threads",
        "paper's method here, ms",
        "paper, i5 3.6 GHz, ms",
    ]
    return markdown(head, lines)


def detection() -> str:
    """Times of one detection on one thread, ours and the peer's in all of its settings."""
    lines = []
    for step in loaded("detection")["steps"]:
        best = {name: sum((peer["broad"], min(peer["narrow"].values()))) for name, peer in step["peer"].items()}
        everything, mesh = best["everything"], step["peer"]["everything"]["mesh"]
        lines.append(
            [
                step["scene"],
                step["vectors"],
                *(number(step[what]) for what in ("build", "first", "again")),
                number(everything),
                f"{number(min(best.values()))} ({min(best, key=lambda name: best[name])})",
                number(everything / step["first"]),
                number(min(best.values()) / step["first"]),
                f"{number(everything / step['build'])} / {number((everything + mesh) / step['build'])}",
            ]
        )
    head = [
        "step",
        "vectors",
        "new detector, ms",
        "first, ms",
        "again, ms",
        "ipctk, everything, ms",
        "ipctk at its best, ms",
        "everything / first",
        "best / first",
        "cold start: everything / new detector, its mesh too",
    ]
    return markdown(head, lines)


def race() -> str:
    """Motion achieved and times of the edits with contacts, compared with a stop by ipctk."""
    lines = []
    for r in loaded("race")["rows"]:
        ours, stop = r["processor_ms_per_edit"], r["processor_ms_per_stop"]
        lines.append(
            [
                r["scene"],
                number(r["kept"] / r["kept_by_stopping"]),
                f"{ours / stop:.2f}",
                f"{ours / r['processor_ms_with_its_detection']:.2f}",
                f"{r['kept']:.3f}, {r['kept_by_stopping']:.3f}",
                ", ".join(
                    number(r[what])
                    for what in (
                        "processor_ms_per_edit",
                        "processor_ms_per_stop",
                        "processor_ms_per_stop_of_everything",
                        "processor_ms_with_its_detection",
                    )
                ),
            ]
        )
    head = [
        "scene",
        "motion achieved, ours / stopping",
        "time, ours / stopping",
        "time, ours / our loop on ipctk",
        "achieved: ours, stopping",
        "ms: ours, stopping, stopping on the complete mesh, on ipctk",
    ]
    return markdown(head, lines)


def trust_regions() -> str:
    """One edit per scene beside the trust regions of offset geometric contact, from ipctk."""
    rows = {row["scene"]: row for row in loaded("trust_region")["rows"]}
    lines = [
        [
            scene,
            *(number(rows[scene][what]) for what in ("search_ms", "update_ms", "narrow_update_ms")),
            f"{rows[scene]['share_of_step']:.3f}",
            f"{rows[scene]['vertices_within_bounds']:.2f}",
            f"{number(rows[scene]['edit_ms'])} / {number(rows[scene]['loop_ms'])}",
            f"{rows[scene]['kept']:.3f} / {rows[scene]['kept_by_loop']:.3f}",
            f"{rows[scene]['energy_ratio']:.3f}",
        ]
        for scene in SCENES
    ]
    head = [
        "scene",
        "our search, ms",
        "update, ms",
        "narrow update, ms",
        "share",
        "vertices within bounds",
        "edit / loop, ms",
        "motion kept, edit / loop",
        "E, edit / loop",
    ]
    return markdown(head, lines)
