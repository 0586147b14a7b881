# SPDX-License-Identifier: GPL-3.0-or-later
"""How near to the goal edits come: the loop against the plain stop at the first contact, and against one constraint.

E = 1/2 |f(p) - f(goal)|^2 of the ways to answer fourteen edits of seven families: truncation at the first contact;
Algorithm 1, with one constraint for all and none kept from round to round; the loop as it is; the loop, then settled.
Prints ratios to the truncation and their geometric means. `python -m benchmarks.energy [--json FILE]`
"""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

import stiv
from blend_fixtures.scenes.families import Edit, all_edits


@dataclass(frozen=True)
class Energies:
    """What the ways leave of one edit, in world units squared, and what the loop cost."""

    edit: str
    status: str
    truncated: float
    single: float  #: one constraint, nothing kept
    full: float
    settled: float
    rounds: int
    intersections: int


def truncated_energy(edit: Edit, separation: float) -> float:
    """E when the edit simply stops at the first contact."""
    goal = edit.deformation.surface(edit.goal)
    events = stiv.find_interference(edit.surface, edit.deformation.surface(edit.controls), goal, separation)
    fraction = float(events.time.min(initial=1.0))
    reached = edit.deformation.surface(edit.controls + fraction * (edit.goal - edit.controls))
    return 0.5 * float(((reached - goal) ** 2).sum())


def measure(edit: Edit) -> Energies:
    """Answer one edit in all ways."""
    session = stiv.EditSession(edit.surface, edit.deformation, edit.controls, stiv.EditOptions(**edit.options))
    result = session.edit(edit.goal)
    settled = session.settle()
    plain = stiv.EditOptions(**{**edit.options, "constraints": "single", "accumulated_rounds": 0, "max_sub_edits": 1})
    single = stiv.edit(edit.surface, edit.deformation, edit.controls, edit.goal, plain)
    return Energies(
        edit.name,
        result.status,
        truncated_energy(edit, session.separation),
        single.energy,
        result.energy,
        settled.energy,
        result.rounds,
        sum(len(stiv.find_intersections(state.surface, edit.surface)) for state in (result, settled, single)),
    )


def mean_ratio(results: list[Energies], what: str) -> float:
    """Geometric mean of one way's energy over that of the truncation."""
    return float(np.exp(np.mean([np.log(getattr(r, what) / r.truncated) for r in results])))


def main() -> None:
    """Print the table, and write it as JSON if asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    arguments = parser.parse_args()
    results = []
    print(f"{'edit':18} {'status':10} {'truncated':>10} {'single':>8} {'full':>8} {'settled':>8} {'rounds':>6}")
    for r in map(measure, all_edits()):
        results.append(r)
        ratios = " ".join(f"{value / r.truncated:8.4f}" for value in (r.single, r.full, r.settled))
        print(f"{r.edit:18} {r.status:10} {r.truncated:10.4g} {ratios} {r.rounds:6d}", flush=True)
    means = {what: mean_ratio(results, what) for what in ("single", "full", "settled")}
    print(f"{'geometric mean':40} " + " ".join(f"{value:8.4f}" for value in means.values()))
    if arguments.json:
        arguments.json.write_text(json.dumps({"edits": [asdict(r) for r in results], "means": means}, indent=2) + "\n")


if __name__ == "__main__":
    main()
