# SPDX-License-Identifier: GPL-3.0-or-later
"""How near to the goal edits come: the defaults against the method as published.

E = 1/2 |f(p) - f(goal)|^2 of fourteen edits of seven families, with the defaults and with `EditOptions.paper`: a
constraint for each patch or one for all, by LCP or by linear equations. A ratio below one says that the defaults come
nearer. Every answer passes the exact test; of the preset's, `fraction` says how much of its last step passed it.
`python -m benchmarks.paper_preset [--json FILE]`
"""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np

import stiv
from blend_fixtures.scenes.families import Edit, all_edits

VARIANTS = {
    "per patch, LCP": {},
    "per patch, linear": {"solver": "linear"},
    "single": {"constraints": "single"},
}


@dataclass(frozen=True)
class Answer:
    """What an edit came to."""

    energy: float
    rounds: int
    fraction: float
    status: str
    intersections: int


@dataclass(frozen=True)
class Comparison:
    """One edit, answered by the defaults and by the variants of the preset."""

    edit: str
    ours: Answer
    paper: dict[str, Answer] = field(default_factory=dict)

    def ratio(self, variant: str) -> float:
        """Energy of the defaults over that of the preset."""
        return self.ours.energy / self.paper[variant].energy


def answer(edit: Edit, options: stiv.EditOptions) -> Answer:
    """Carry out one edit."""
    result = stiv.edit(edit.surface, edit.deformation, edit.controls, edit.goal, options)
    pairs = stiv.find_intersections(result.surface, edit.surface)
    return Answer(result.energy, result.rounds, result.fraction, result.status, len(pairs))


def compare(edit: Edit) -> Comparison:
    """Answer one edit in all ways."""
    paper = {
        name: answer(edit, stiv.EditOptions.paper(**{**edit.options, **variant})) for name, variant in VARIANTS.items()
    }
    return Comparison(edit.name, answer(edit, stiv.EditOptions(**edit.options)), paper)


def main() -> None:
    """Print the table, and write it as JSON if asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    arguments = parser.parse_args()
    print(stiv.PAPER_DIFFERENCES)
    print(f"{'edit':18} {'E':>9} {'rounds':>6}" + "".join(f" | {name:>24}" for name in VARIANTS))
    print(f"{'':18} {'':9} {'':6}" + " |  ratio  rounds  fraction" * len(VARIANTS))
    comparisons = []
    for comparison in map(compare, all_edits()):
        comparisons.append(comparison)
        columns = "".join(
            f" | {comparison.ratio(name):6.4f} {paper.rounds:6d} {paper.fraction:9.4f}  "
            for name, paper in comparison.paper.items()
        )
        print(f"{comparison.edit:18} {comparison.ours.energy:9.4g} {comparison.ours.rounds:6d}{columns}", flush=True)
    ratios = {name: [comparison.ratio(name) for comparison in comparisons] for name in VARIANTS}
    means = {name: float(np.exp(np.mean(np.log(values)))) for name, values in ratios.items()}
    for name in VARIANTS:
        worst = max(comparisons, key=lambda comparison: comparison.ratio(name))
        print(f"{name}: geometric mean {means[name]:.4f}, worst {worst.ratio(name):.4f} ({worst.edit})")
    answers = [answer for comparison in comparisons for answer in (comparison.ours, *comparison.paper.values())]
    print(f"intersections in all answers: {sum(answer.intersections for answer in answers)}")
    if arguments.json:
        table = {"edits": [asdict(comparison) for comparison in comparisons], "means": means}
        arguments.json.write_text(json.dumps(table, indent=2) + "\n")


if __name__ == "__main__":
    main()
