# SPDX-License-Identifier: GPL-3.0-or-later
"""Cost of deformations by handles on one thread: set-up, a surface, a constraint, the metric.

A wavy sheet of 40,000 vertices under Laplacian editing with few, 500 and 3,000 handles, soft and hard, and an
as-rigid-as-possible sheet of 6,400. `python -m benchmarks.handle_solves [--json FILE]`
"""

from __future__ import annotations

import argparse
import functools
import json
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

import stiv
from blend_fixtures.scenes.primitives import grid, triangulated

REPEATS = 4
COSTS = ("setup", "surface", "constraint", "metric")


@dataclass(frozen=True)
class HandleCosts:
    """Processor milliseconds, the minimum over repeats; set-up is measured once."""

    deformation: str
    vertices: int
    handles: int
    setup: float
    surface: float
    constraint: float  #: J' of a covector over the four vertices of a contact
    metric: float


def milliseconds(work: Callable[[], object], repeats: int = 1) -> float:
    """The minimum processor time over several calls."""
    found = []
    for _ in range(repeats):
        begin = time.process_time()
        work()
        found.append(1000 * (time.process_time() - begin))
    return min(found)


def measure(name: str, make: Callable[..., stiv.Deformation], cells: int, handle_count: int) -> HandleCosts:
    """Measure a patch of handles in the centre of the sheet, moved up; the boundary is fixed."""
    sheet = triangulated(grid(cells, cells))
    vertices = sheet.vertices + np.sin(7 * sheet.vertices[:, :1]) * (0, 0, 0.05)
    triangles = sheet.triangles()
    x, y = (vertices[:, axis] / np.ptp(vertices[:, axis]) for axis in (0, 1))
    handles = np.argsort(np.hypot(x, y), kind="stable")[:handle_count]
    rim = np.flatnonzero(np.maximum(abs(x), abs(y)) > 0.495)
    setup = milliseconds(lambda: make(vertices, triangles, handles, fixed=rim))
    deformation = make(vertices, triangles, handles, fixed=rim)
    goals = [vertices[handles] + (0, 0, 0.1 + 0.01 * k) for k in range(REPEATS)]
    surface = min(milliseconds(lambda goal=goal: deformation.surface(goal)) for goal in goals)  # type: ignore[misc]
    contact = np.zeros_like(vertices)
    contact[[len(x) // 3 + k for k in range(4)]] = (0, 0, 1)
    constraint = milliseconds(lambda: deformation.pull_back(goals[-1], contact), REPEATS)
    step = np.ones((handle_count, 3))
    metric = milliseconds(lambda: deformation.apply_inverse_metric(goals[-1], step))
    return HandleCosts(name, len(vertices), handle_count, setup, surface, constraint, metric)


def main() -> None:
    """Print the table, and optionally write it as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    arguments = parser.parse_args()
    results = []
    print("processor milliseconds")
    print(f"{'deformation':12} {'vertices':>8} {'handles':>7} " + " ".join(f"{what:>10}" for what in COSTS))
    for name, make, cells, handles in (
        ("laplacian", stiv.laplacian, 199, 50),
        ("laplacian", stiv.laplacian, 199, 500),
        ("laplacian", stiv.laplacian, 199, 3000),
        ("hard", functools.partial(stiv.laplacian, pull=None), 199, 3000),
        ("arap", stiv.arap, 79, 200),
    ):
        r = measure(name, make, cells, handles)
        results.append(asdict(r))
        figures = " ".join(f"{getattr(r, what):10.1f}" for what in COSTS)
        print(f"{r.deformation:12} {r.vertices:8d} {r.handles:7d} {figures}", flush=True)
    if arguments.json:
        arguments.json.write_text(json.dumps(results, indent=2) + "\n")


if __name__ == "__main__":
    main()
