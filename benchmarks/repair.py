# SPDX-License-Identifier: GPL-3.0-or-later
"""Results and cost of repair, for the tangles of the scene library and meshes from files.

`python -m benchmarks.repair [--models FOLDER] [--json FILE]`: every OBJ of the folder is welded first.
Deviations are root mean squares over the vertices, in diagonals of the bounding box; times are CPU seconds of
one thread.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

import stiv
from blend_fixtures.scenes.tangled import Tangle, all_tangles
from stiv.mesh_files import read_mesh


@dataclass(frozen=True)
class Row:
    """One repair."""

    name: str
    vertices: int
    status: str
    refusal: str
    contracted: str
    pairs_before: int
    fewest_pairs: int
    pairs_left: int  #: by a separate exact test
    steps: int
    rounds: int
    deviation: float
    seconds: float


def models(folder: Path) -> Iterator[Tangle]:
    """All OBJ files of the folder, sorted by name."""
    for path in sorted(folder.glob("*.obj")):
        mesh = read_mesh(path)
        yield Tangle(path.stem, stiv.Surface(mesh.triangles, len(mesh.vertices)), np.asarray(mesh.vertices, float))


def measure(tangle: Tangle, weld: bool = False) -> Row:
    """Measure one repair."""
    options = stiv.RepairOptions(weld=weld, edit=stiv.EditOptions(threads=1))
    begin = time.process_time()
    result = stiv.repair(tangle.surface, tangle.positions, options)
    seconds = time.process_time() - begin
    return Row(
        tangle.name,
        result.surface.vertex_count,
        result.status,
        result.refusal,
        result.contracted,
        result.pairs_before,
        result.fewest_pairs,
        len(stiv.find_intersections(result.positions, result.surface)),
        result.steps,
        result.counters["rounds"],
        result.deviation,
        seconds,
    )


def main() -> None:
    """Print the table, and optionally write it as JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=Path, help="folder of OBJ files to repair as well, after welding")
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    arguments = parser.parse_args()
    rows = []
    print(f"{'scene':18} {'vertices':>8} {'status':12} {'contracted':12} {'pairs':>6} {'best':>6} {'left':>6}", end="")
    print(f" {'steps':>5} {'rounds':>6} {'deviation':>9} {'seconds':>7}")

    def show(row: Row) -> None:
        rows.append(row)
        print(
            f"{row.name:18} {row.vertices:8d} {row.status:12} {row.refusal or row.contracted:12} {row.pairs_before:6d} "
            f"{row.fewest_pairs:6d} {row.pairs_left:6d} {row.steps:5d} {row.rounds:6d} {row.deviation:9.4%} "
            f"{row.seconds:7.2f}",
            flush=True,
        )

    for tangle in all_tangles():
        show(measure(tangle))
    if arguments.models is None:
        print("no --models FOLDER: meshes of files are left out")
    else:
        for tangle in models(arguments.models):
            show(measure(tangle, weld=True))
    if arguments.json:
        arguments.json.write_text(json.dumps([asdict(row) for row in rows], indent=2) + "\n")


if __name__ == "__main__":
    main()
