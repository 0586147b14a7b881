# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact static test compared with ipctk, libigl and CGAL on the same meshes, one thread.

Milliseconds of processor time, the minimum over alternating repeats.

    new        find_intersections from plain triangles: connectivity, trees, all pairs
surface    the same for a Surface: trees, all pairs
    reused     IntersectionTest with existing trees: all pairs
ipctk      has_intersections: whether there is any, not exact
    libigl     find_self_intersections: all pairs
    igl first  the same, which ends at the first
    CGAL       self_intersections: all pairs

`python -m benchmarks.intersections [--models FOLDER] [--json FILE]`; tools/requirements/bench.txt
includes ipctk and libigl; CGAL needs Debian's libcgal-dev and `make peers`.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import stiv
from benchmarks.detection.measurement import Stopwatch
from blend_fixtures.scenes.detection_steps import STEPS
from stiv.mesh_files import read_mesh

from . import peers

COLUMNS = ("new", "surface", "reused", "ipctk", "libigl", "igl first", "CGAL")
SCENES = ("pressed", "vase", "soup", "knot", "shell", "panel")


@dataclass(frozen=True)
class Mesh:
    """A mesh to test."""

    name: str
    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]


def meshes(folder: Path | None) -> Iterator[Mesh]:
    """Starts of the steps of the detection benchmark, and the unchanged files of a folder."""
    for name in SCENES:
        step = STEPS[name]()
        yield Mesh(step.name, step.start, step.triangles)
    for path in sorted(folder.glob("*.obj")) if folder else []:
        mesh = read_mesh(path)
        welded = stiv.weld(mesh.triangles, np.asarray(mesh.vertices, float))
        yield Mesh(path.stem, welded.positions, welded.surface.triangles)


def measure(mesh: Mesh, repeats: int, cgal: Path) -> dict[str, object]:
    """Milliseconds by column, and the number of pairs found by each exact method."""
    watch = Stopwatch(1)
    surface = stiv.Surface(mesh.faces, vertex_count=len(mesh.vertices))
    kept = stiv.IntersectionTest(surface, threads=1)
    runs: dict[str, Callable[[], object] | None] = {
        "new": lambda: stiv.find_intersections(mesh.vertices, mesh.faces, threads=1),
        "surface": lambda: stiv.find_intersections(mesh.vertices, surface, threads=1),
        "reused": lambda: kept.find(mesh.vertices),
        "ipctk": peers.ipc_toolkit(mesh.vertices, mesh.faces),
        "libigl": peers.libigl(mesh.vertices, mesh.faces),
        "igl first": peers.libigl(mesh.vertices, mesh.faces, first_only=True),
    }
    program = peers.Cgal(cgal, mesh.vertices, mesh.faces)
    pairs: dict[str, float] = {"stiv": len(kept.find(mesh.vertices))}
    for _ in range(repeats):
        for name, run in runs.items():
            if run:
                watch.run(name, run)
        result = program.run(1)
        if result:
            watch.least["CGAL"] = min(watch.least.get("CGAL", np.inf), result["all"])
            pairs["CGAL"] = result["pairs"]
    return {"mesh": mesh.name, "triangles": len(mesh.faces), "milliseconds": watch.least, "pairs": pairs}


def print_row(mesh: Mesh, least: dict[str, float], pairs: dict[str, float]) -> None:
    """One line; the ratio compares the fastest exact peer for all pairs with our test with existing trees."""
    times = " ".join(f"{least[name]:9.1f}" if name in least else f"{'-':>9}" for name in COLUMNS)
    others = [name for name in ("ipctk", "libigl", "igl first", "CGAL") if name in least]
    ratios = [least[name] / least["surface"] for name in others]
    kept = [least[name] / least["reused"] for name in others]
    ratio = f"{min(ratios):7.1f} {min(kept):7.1f}" if ratios else f"{'-':>7} {'-':>7}"
    print(f"{mesh.name:18} {len(mesh.faces):9,} {pairs['stiv']:8,} | {times} | {ratio}", flush=True)


def main() -> None:
    """Print the table, and optionally write it as JSON."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=5, help="default: 5")
    parser.add_argument("--models", type=Path, help="folder of .obj files to test too")
    parser.add_argument("--cgal", type=Path, default=peers.CGAL, help=f"program of CGAL's test, default {peers.CGAL}")
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    arguments = parser.parse_args()
    header = " ".join(f"{name:>9}" for name in COLUMNS)
    print(f"{'mesh':18} {'triangles':>9} {'pairs':>8} | {header} | quickest peer / surface, / kept")
    rows = []
    for mesh in meshes(arguments.models):
        row = measure(mesh, arguments.repeats, arguments.cgal)
        rows.append(row)
        print_row(mesh, row["milliseconds"], row["pairs"])  # type: ignore[arg-type]
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=2) + "\n")


if __name__ == "__main__":
    main()
