# SPDX-License-Identifier: GPL-3.0-or-later
"""Distance of edits from their goals: the loop, a stop at the first contact, and a single constraint.

E = 1/2 |f(p) - f(goal)|^2 for fourteen edits of seven families with four methods: truncation at the first
contact; Algorithm 1 with one constraint for all contacts and no accumulation; the default loop; the default
loop, settled. Prints ratios to the truncation and their geometric means. For the rigid body, whose minimum
can be found by other means, prints the ratio to the minimum. `python -m benchmarks.energy [--json FILE]`
"""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import stiv
from blend_fixtures.scenes.families import Edit, all_edits


@dataclass(frozen=True)
class Energies:
    """Energies of one edit by all methods, in world units squared, and the cost of the loop."""

    edit: str
    status: str
    truncated: float
    single: float  #: one constraint, no accumulation
    full: float
    settled: float
    rounds: int
    settling_rounds: int
    intersections: int
    optimum: float | None = None  #: the minimum, if known


def truncated_energy(edit: Edit, separation: float) -> float:
    """E if the edit stops at the first contact."""
    goal = edit.deformation.surface(edit.goal)
    start = edit.deformation.surface(edit.controls)
    fraction = min(stiv.Detector(edit.surface).earliest_time(start, goal, separation), 1.0)
    reached = edit.deformation.surface(edit.controls + fraction * (edit.goal - edit.controls))
    return 0.5 * float(((reached - goal) ** 2).sum())


def rotated(vectors: NDArray[np.float64], turn: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vectors (n, 3) rotated by a rotation vector (Rodrigues' formula)."""
    angle = float(np.linalg.norm(turn))
    axis = turn / angle if angle > 0 else np.array([0.0, 0.0, 1.0])
    across, along = np.cross(axis, vectors), (vectors @ axis)[:, None] * axis
    return along + np.cos(angle) * (vectors - along) + np.sin(angle) * across


def least_energy_above_wall(edit: Edit, separation: float) -> float:
    """The minimum of E for a rigid body that `edit` pushes into the plane z = 0, by random search.

    For a given rotation, the best position is the goal, raised until the lowest vertex is at the separation. Only the
        rotation is therefore searched, by an evolution strategy with one parent [Rechenberg 1973, the 1/5 rule].
    """
    body = edit.surface.vertex_body == 0
    goal = edit.deformation.surface(edit.goal)[body]
    centre = goal.mean(axis=0)
    arms = goal - centre

    def energy(turn: NDArray[np.float64]) -> float:
        turned = rotated(arms, turn)
        raised = max(separation - (centre[2] + turned[:, 2].min()), 0.0)
        return 0.5 * float(((turned - arms) ** 2).sum()) + 0.5 * len(arms) * raised**2

    chance = np.random.default_rng(0)
    turn, step = np.zeros(3), 0.1
    least = energy(turn)
    for _ in range(4000):
        trial = turn + step * chance.normal(size=3)
        found = energy(trial)
        if found < least:
            turn, least, step = trial, found, 1.5 * step
        else:
            step = max(step / 1.5**0.25, 1e-9)
    return least


def measure(edit: Edit) -> Energies:
    """Solve one edit by all methods."""
    session = stiv.EditSession(edit.surface, edit.deformation, edit.controls, stiv.EditOptions(**edit.options))
    result = session.edit(edit.goal)
    settled = session.settle()
    wall = edit.name.startswith("rigid")
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
        settled.rounds,
        sum(len(stiv.find_intersections(state.surface, edit.surface)) for state in (result, settled, single)),
        least_energy_above_wall(edit, session.separation) if wall else None,
    )


def mean_ratio(results: list[Energies], what: str) -> float:
    """Geometric mean of one method's energy relative to the truncation."""
    return float(np.exp(np.mean([np.log(getattr(r, what) / r.truncated) for r in results])))


def main() -> None:
    """Print the table, and optionally write it as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    arguments = parser.parse_args()
    results = []
    print(
        f"{'edit':18} {'status':10} {'truncated':>10} {'single':>8} {'full':>8} {'settled':>8} {'rounds':>6} + settling"
    )
    for r in map(measure, all_edits()):
        results.append(r)
        ratios = " ".join(f"{value / r.truncated:8.4f}" for value in (r.single, r.full, r.settled))
        near = f"  settled / optimum {r.settled / r.optimum:.4f}" if r.optimum else ""
        print(
            f"{r.edit:18} {r.status:10} {r.truncated:10.4g} {ratios} {r.rounds:6d} + {r.settling_rounds:8d}{near}",
            flush=True,
        )
    means = {what: mean_ratio(results, what) for what in ("single", "full", "settled")}
    print(
        f"{'geometric mean':40} " + " ".join(f"{value:8.4f}" for value in means.values()),
        f"{sum(r.rounds for r in results):6d} + {sum(r.settling_rounds for r in results):8d}",
    )
    if arguments.json:
        arguments.json.write_text(json.dumps({"edits": [asdict(r) for r in results], "means": means}, indent=2) + "\n")


if __name__ == "__main__":
    main()
