# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits by handles against thousands of contacts, on one thread: a sheet is pressed onto fixed ground with
small hills.

`python -m benchmarks.handle_contacts [--only NAME] [--json FILE]`: Laplacian editing of 40,000 vertices with
500 and 3,000 soft handles, in a patch and scattered, and 1,600 as-rigid-as-possible vertices; at most 16
rounds.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

import stiv
from blend_fixtures.scenes.primitives import grid, triangulated
from blend_fixtures.scenes.shape import joined

ROUNDS = 16  #: from the second on, few contacts are separate constraints
PRESS = 0.05  #: depth of the goal below the tops of the hills, in widths of the sheet


@dataclass(frozen=True)
class Case:
    """A sheet of cells x cells squares, its deformation, and its handles."""

    name: str
    make: Callable[..., stiv.Deformation]
    cells: int
    handles: int
    scattered: bool


@dataclass(frozen=True)
class Row:
    """One edit, in processor seconds; `response` is the wall time of one thread."""

    name: str
    vertices: int
    handles: int
    contacts: int  #: events of the first step, from the start to the goal
    rounds: int
    status: str
    energy: float  #: relative to that of the start
    setup: float
    seconds: float
    response: float


CASES = (
    Case("laplacian patch", stiv.laplacian, 199, 500, False),
    Case("laplacian patch", stiv.laplacian, 199, 3000, False),
    Case("laplacian scattered", stiv.laplacian, 199, 3000, True),
    Case("arap", stiv.arap, 39, 100, True),
)


def measure(case: Case) -> Row:
    """Press the sheet onto the hills in one edit."""
    sheet = triangulated(grid(case.cells, case.cells)).moved((0, 0, 0.05))
    ground = triangulated(grid(160, 160, 1.3, 1.3))
    x, y, _ = ground.vertices.T
    hills = ground.vertices + np.stack([0 * x, 0 * x, 0.02 * (np.cos(40 * x) * np.cos(36 * y) - 1)], axis=1)
    whole = joined([sheet, type(sheet)(hills, ground.faces)])
    count = len(sheet.vertices)
    owner = np.repeat([0, 1], [count, len(hills)])
    surface = stiv.Surface(
        whole.triangles(), len(whole.vertices), vertex_body=owner, bodies=[stiv.Body("sheet"), stiv.Body("g", "fixed")]
    )
    middle = np.hypot(*sheet.vertices[:, :2].T)
    if case.scattered:
        handles = np.random.default_rng(1).permutation(count)[: case.handles]
    else:
        handles = np.argsort(middle, kind="stable")[: case.handles]
    begin = time.process_time()
    moved = case.make(sheet.vertices, sheet.triangles(), np.sort(handles))
    deformation = stiv.concatenate([(moved, np.arange(count))], whole.vertices)
    start = sheet.vertices[np.sort(handles)]
    options = stiv.EditOptions(threads=1, max_sub_edits=1, max_rounds=ROUNDS)
    session = stiv.EditSession(surface, deformation, start, options)
    setup = time.process_time() - begin
    goal = start - (0, 0, 0.05 + PRESS)
    wanted = deformation.surface(goal)
    contacts = len(stiv.find_interference(surface, whole.vertices, wanted, session.separation).time)
    begin = time.process_time()
    result = session.edit(goal)
    seconds = time.process_time() - begin
    share = result.energy / (0.5 * ((whole.vertices - wanted) ** 2).sum())
    response = result.timings["response"]
    return Row(case.name, count, case.handles, contacts, result.rounds, result.status, share, setup, seconds, response)


def main() -> None:
    """Print the table, and optionally write it as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="cases whose name and number of handles begin so")
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    arguments = parser.parse_args()
    rows = []
    print(f"{'deformation':20} {'vertices':>8} {'handles':>7} {'contacts':>8} {'rounds':>6} {'status':>9}", end="")
    print(f" {'energy':>7} {'setup s':>7} {'edit s':>7} {'response':>8}")
    for case in CASES:
        if not f"{case.name} {case.handles}".startswith(arguments.only):
            continue
        r = measure(case)
        rows.append(asdict(r))
        print(
            f"{r.name:20} {r.vertices:8d} {r.handles:7d} {r.contacts:8d} {r.rounds:6d} {r.status:>9} {r.energy:7.3f} "
            f"{r.setup:7.2f} {r.seconds:7.2f} {r.response:8.2f}",
            flush=True,
        )
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=2) + "\n")


if __name__ == "__main__":
    main()
