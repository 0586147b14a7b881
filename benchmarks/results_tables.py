# SPDX-License-Identifier: GPL-3.0-or-later
"""Write the tables of benchmarks/results/README.md from the JSON files beside it.

Each table is enclosed in `<!-- begin NAME -->` and `<!-- end NAME -->`. `python -m benchmarks.results_tables`
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from benchmarks.sessions.table1 import PUBLISHED

FOLDER = Path(__file__).parent / "results"
SCENES = tuple(PUBLISHED)


def loaded(name: str) -> Any:
    """The content of one JSON file."""
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def number(value: float) -> str:
    """Two or three digits, without an exponent."""
    return f"{value:.0f}" if value >= 20 else f"{value:.2g}" if value < 10 else f"{value:.1f}"


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


def settled() -> str:
    """Energies of solutions settled until nothing changes."""
    lines = [
        [
            scene["scene"],
            str(scene["edits"]),
            *(f"{value:.2f}" for value in scene["energies"].values()),
            str(scene["paper_nearer"]),
        ]
        for scene in sorted(loaded("settled_edits"), key=lambda scene: SCENES.index(scene["scene"]))
    ]
    head = ["scene", "edits", "ours", "ours, settled", "paper", "paper, settled", "best of each", "paper closer in"]
    return markdown(head, lines)


def whole_drags() -> str:
    """Energies of whole drags relative to a stop at the first contact."""
    content = loaded("whole_drags")
    order = sorted(content["drags"], key=lambda drag: SCENES.index(drag["scene"]))
    lines = [
        [
            f"{drag['scene']}: {drag['stage'].replace('_', ' ')}",
            f"{100 * drag['step']:.0f} %",
            f"{drag['contacts']:.0f}",
            *(f"{value:.3f}" for value in drag["energies"].values()),
        ]
        for drag in order
    ]
    lines.append(["geometric mean", "", "", *(f"{value:.3f}" for value in content["means"].values())])
    return markdown(["drag", "step", "contacts per round", *content["means"]], lines)


def fourteen() -> str:
    """Energies of the fourteen edits relative to a stop at the first contact."""
    content = loaded("paper_preset")
    lines = []
    for edit in content["edits"]:
        energies = [edit["ours"]["energy"], edit["settled"], *(answer["energy"] for answer in edit["paper"].values())]
        least = "" if edit["converged"] is None else f"{edit['converged'] / edit['stopped']:.4f}"
        if least and not edit["converged_in_time"]:
            least += " (time over)"
        lines.append([edit["edit"], *(f"{energy / edit['stopped']:.4f}" for energy in energies), least])
    lines.append(["geometric mean", *(f"{value:.4f}" for value in content["means"].values()), ""])
    return markdown(["edit", *content["means"], "interior point"], lines)


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


TABLES: dict[str, Callable[[], str]] = {
    make.__name__: make for make in (table1, settled, whole_drags, fourteen, detection, race)
}


def filled(text: str) -> str:
    """The text with updated tables."""
    for name, make in TABLES.items():
        block = re.compile(rf"(<!-- begin {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
        text, count = block.subn(lambda match, make=make: match[1] + make() + "\n" + match[2], text)  # type: ignore[misc]
        if count != 1:
            raise ValueError(f"README.md of the results has {count} places for the table {name!r}")
    return text


def main() -> None:
    """Update README.md."""
    path = FOLDER / "README.md"
    path.write_text(filled(path.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
