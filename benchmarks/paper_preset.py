# SPDX-License-Identifier: GPL-3.0-or-later
"""Distance of edits from their goals: our defaults, the published method, a stop at the first contact, and
convergence.

E = 1/2 |f(p) - f(goal)|^2 of fourteen edits of seven families, relative to the stop: by the defaults, and
settled until nothing changes; by `EditOptions.paper` with a constraint per patch (LCP or linear equations) or
one for all; by `EditOptions.paper_frozen`. `--converged` adds the minimum of an interior-point method from
the start and from our solution (interior_point.py; needs ipctk and SciPy). Every solution passes the exact
test; for the paper's method, `fraction` gives the accepted part of its last step. `python -m
benchmarks.paper_preset [--converged SECONDS] [--json FILE]`
"""

from __future__ import annotations

import argparse
import importlib
import json
from dataclasses import asdict, dataclass, field
from pathlib import Path

import stiv
from benchmarks.sessions.running import Preset
from blend_fixtures.scenes.families import Edit, all_edits

from .settling import Array, geometric_mean, settle, stopped_energy

VARIANTS: dict[str, tuple[Preset, dict[str, str]]] = {
    "paper, LCP": (stiv.EditOptions.paper, {}),
    "paper, linear": (stiv.EditOptions.paper, {"solver": "linear"}),
    "paper, single": (stiv.EditOptions.paper, {"constraints": "single"}),
    "frozen, LCP": (stiv.EditOptions.paper_frozen, {}),
}
CALLS = 30  #: of settle, at most


@dataclass(frozen=True)
class Answer:
    """Result of an edit."""

    energy: float
    rounds: int
    fraction: float
    status: str
    intersections: int


@dataclass(frozen=True)
class Comparison:
    """One edit by all methods; energies in world units squared."""

    edit: str
    stopped: float
    ours: Answer
    settled: float
    settling_calls: int  #: CALLS: still changing at the end
    paper: dict[str, Answer] = field(default_factory=dict)
    converged: float | None = None  #: minimum of the interior-point method; None: not requested, or not linear
    converged_in_time: bool = False

    def relative(self) -> dict[str, float]:
        """Energies relative to the stop."""
        energies = {"ours": self.ours.energy, "settled": self.settled}
        energies |= {name: answer.energy for name, answer in self.paper.items()}
        return {name: energy / self.stopped for name, energy in energies.items()}


def answer(edit: Edit, options: stiv.EditOptions) -> Answer:
    """Solve one edit."""
    result = stiv.edit(edit.surface, edit.deformation, edit.controls, edit.goal, options)
    pairs = stiv.find_intersections(result.surface, edit.surface)
    return Answer(result.energy, result.rounds, result.fraction, result.status, len(pairs))


def compare(edit: Edit, seconds: float) -> Comparison:
    """Solve one edit by all methods; `seconds` limits each run of the interior-point method, 0: none."""
    options = stiv.EditOptions(**edit.options)  # type: ignore[arg-type]
    session = stiv.EditSession(edit.surface, edit.deformation, edit.controls, options)
    first = session.edit(edit.goal)
    controls = first.controls
    settled = settle(session, first.energy, CALLS)
    start, goal = edit.deformation.surface(edit.controls), edit.deformation.surface(edit.goal)
    paper = {name: answer(edit, preset(**{**edit.options, **more})) for name, (preset, more) in VARIANTS.items()}
    least, in_time = converged(edit, session.separation, [edit.controls, controls], seconds)
    pairs = len(stiv.find_intersections(first.surface, edit.surface))
    return Comparison(
        edit.name,
        stopped_energy(edit.surface, start, goal, session.separation),
        Answer(first.energy, first.rounds, first.fraction, first.status, pairs),
        settled.energy,
        settled.calls,
        paper,
        least,
        in_time,
    )


def converged(edit: Edit, separation: float, starts: list[Array], seconds: float) -> tuple[float | None, bool]:
    """Return the minimum energy of the interior-point method from several starts, and whether all ended in time."""
    if seconds == 0 or edit.name.startswith("rigid"):
        return None, False
    interior_point = importlib.import_module("benchmarks.interior_point")
    ipctk = importlib.import_module("ipctk")
    found = [interior_point.InteriorPoint(ipctk, edit, separation, seconds).solve(start) for start in starts]
    return min(optimum.energy for optimum in found), all(optimum.converged for optimum in found)


def line(comparison: Comparison) -> str:
    """One edit."""
    columns = [f"{value:7.4f}" for value in comparison.relative().values()]
    rounds = " ".join(f"{a.rounds:3d} {a.fraction:4.2f}" for a in comparison.paper.values())
    least = "" if comparison.converged is None else f"{comparison.converged / comparison.stopped:7.4f}"
    late = "" if comparison.converged_in_time or not least else " (time was over)"
    return f"{comparison.edit:16} {comparison.ours.rounds:4d} {' '.join(columns)} {least:>7}{late} | {rounds}"


def main() -> None:
    """Print the table, and optionally write it as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--converged", type=float, default=0, metavar="SECONDS", help="for each interior-point run")
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    arguments = parser.parse_args()
    print(stiv.PAPER_DIFFERENCES)
    print("E over that of the stop: ours, settled, " + ", ".join(VARIANTS) + ", interior point | rounds, fraction")
    comparisons = []
    for edit in all_edits():
        comparisons.append(compare(edit, arguments.converged))
        print(line(comparisons[-1]), flush=True)
    relative = [comparison.relative() for comparison in comparisons]
    means = {name: geometric_mean([row[name] for row in relative]) for name in relative[0]}
    print("geometric means over the stop: " + ", ".join(f"{name} {value:.4f}" for name, value in means.items()))
    for name in VARIANTS:
        worst = max(range(len(relative)), key=lambda k: relative[k]["ours"] / relative[k][name])
        ratio = relative[worst]["ours"] / relative[worst][name]
        print(f"ours over {name}: {means['ours'] / means[name]:.4f}, worst {ratio:.4f} ({comparisons[worst].edit})")
    near = [c for c in comparisons if c.converged is not None]
    if near:
        for what, energies in (("ours", [c.ours.energy for c in near]), ("settled", [c.settled for c in near])):
            ratios = [energy / (c.converged or energy) for energy, c in zip(energies, near, strict=True)]
            print(f"{what} over the interior point: {geometric_mean(ratios):.3f}, worst {max(ratios):.3f}")
    answers = [a for c in comparisons for a in (c.ours, *c.paper.values())]
    print(f"intersections in all answers: {sum(a.intersections for a in answers)}")
    if arguments.json:
        table = {"edits": [asdict(comparison) for comparison in comparisons], "means": means}
        arguments.json.write_text(json.dumps(table, indent=2) + "\n")


if __name__ == "__main__":
    main()
