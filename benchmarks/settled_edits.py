# SPDX-License-Identifier: GPL-3.0-or-later
"""The edits of Table 1 and converged solutions: ours and the paper's, each settled until nothing changes.

For a sample of the edits with contacts: E = 1/2 |f(p) - f(goal)|^2 by the defaults, by `EditOptions.paper`,
of both settled, and their minimum per edit; sums relative to the paper's solutions. `python -m
benchmarks.settled_edits [--scenes NAME ...] [--calls N] [--json FILE]`
"""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

import stiv
from benchmarks.sessions.running import record, solver_of
from blend_fixtures.scenes.sessions.catalogue import table_sessions

from .settling import settle, settle_from

EVERY = {"plant": 6, "hare": 20, "tree": 4, "knot": 1, "dressing": 6}  #: of the edits with contacts
WAYS = ("ours", "ours settled", "paper", "paper settled", "best")


@dataclass(frozen=True)
class Scene:
    """Mean energies of one scene's sample relative to the paper's solutions."""

    scene: str
    edits: int
    energies: dict[str, float]
    ours_over_best: float  #: geometric mean over the edits
    paper_nearer: int  #: edits in which the paper's solution is closer to the goal than ours
    still_changing: int  #: settlings that reached their limit of calls


def measure(name: str, calls: int) -> Scene:
    """Solve a sample of the edits of one scene by all methods."""
    recorded, figures = record(table_sessions()[name], {"threads": 1}, lambda note: None)
    tasks = [(part.stage, task) for part in recorded for task in part.tasks]
    touching = [task for task, figure in zip(tasks, figures, strict=True) if figure.touches]
    rows, late = [], 0
    for stage, task in touching[:: EVERY[name]]:
        solver = solver_of(stage, {"threads": 1})
        solver.restore(task.start)
        ours = solver.edit(task.goal)
        settled = settle(solver, ours.energy, calls)
        published = solver_of(stage, {"threads": 1}, stiv.EditOptions.paper)
        published.restore(task.start)
        paper = published.edit(task.goal)
        paper_settled = settle_from(solver, paper.controls, task.goal, calls)
        energies = [ours.energy, settled.energy, paper.energy, min(paper.energy, paper_settled.energy)]
        rows.append([*energies, min(energies)])
        late += (settled.calls == calls) + (paper_settled.calls == calls)
    table = np.array(rows)
    relative = table.mean(axis=0) / table[:, 2].mean()
    return Scene(
        name,
        len(table),
        dict(zip(WAYS, relative.tolist(), strict=True)),
        float(np.exp(np.log(table[:, 0] / table[:, 4]).mean())),
        int((table[:, 2] < table[:, 0]).sum()),
        late,
    )


def main() -> None:
    """Print the table, and optionally write it as JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenes", nargs="+", choices=[*EVERY], default=[*EVERY], help="default: all")
    parser.add_argument("--calls", type=int, default=8, help="of settle, at most (default: 8)")
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    arguments = parser.parse_args()
    print(f"{'scene':9} {'edits':>5} " + " ".join(f"{way:>13}" for way in WAYS) + "  ours/best  paper nearer  changing")
    scenes = []
    for name in arguments.scenes:
        scenes.append(measure(name, arguments.calls))
        s = scenes[-1]
        values = " ".join(f"{s.energies[way]:13.4f}" for way in WAYS)
        print(
            f"{s.scene:9} {s.edits:5d} {values} {s.ours_over_best:10.3f} {s.paper_nearer:13d} {s.still_changing:9d}",
            flush=True,
        )
    if arguments.json:
        arguments.json.write_text(json.dumps([asdict(scene) for scene in scenes], indent=2) + "\n")


if __name__ == "__main__":
    main()
