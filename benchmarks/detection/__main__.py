# SPDX-License-Identifier: GPL-3.0-or-later
"""Detection of one step, our detector and ipctk, and its scaling.

Milliseconds, the minimum over alternating repeats: processor time for one thread, wall time for more.

build      a new detector and its first search: every event with its time
    first      a full detection by a detector with trees: every event with its time
    again      a further search from the same start to a closer end: the next round of an edit
    all        ipctk on the complete mesh: LBVH and the faster of its narrow phases, for the earliest time only
    at best    the same in its fastest setting: static pairs filtered, or culled to the moving surface
    mesh       culling and ipctk's own mesh, once per drag: included neither in "all" nor in "at best"

all/build compares cold starts with new connectivity and trees; (all+mesh)/build includes those of ipctk.

`python -m benchmarks.detection [--scenes NAME ...] [--threads 1 2] [--vectors avx512 avx2 baseline] [--models
FOLDER] [--json FILE]`. tools/requirements/bench.txt includes ipctk; without it, its columns are empty.
`--vectors` limits our vector code to that of older processors; ipctk is not limited.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from dataclasses import asdict
from itertools import product
from pathlib import Path

from blend_fixtures.scenes.detection_steps import STEPS, Step
from stiv import _native

from . import growth, models, table
from .hits import count_hits
from .ipc_toolkit import load
from .measurement import measure

GROWTH = "growth"
VECTOR_TARGETS = _native.VectorTarget.__members__


def chosen(scenes: list[str], folder: Path | None) -> Iterator[Step]:
    """Build one step after another."""
    for name in scenes:
        if name != GROWTH:
            yield STEPS[name]()
    if folder:
        yield from models.steps(folder)


def parse() -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    names = [*STEPS, GROWTH]
    parser.add_argument("--scenes", nargs="*", choices=names, default=names, help="default: all")
    parser.add_argument("--threads", nargs="+", type=int, default=[1, 2], help="default: 1 2")
    best = _native.best_vector_target().name
    parser.add_argument("--vectors", nargs="+", choices=[*VECTOR_TARGETS], default=[best], help=f"default: {best}")
    parser.add_argument("--repeats", type=int, default=7, help="default: 7")
    parser.add_argument("--models", type=Path, help="folder of .obj files to measure too")
    parser.add_argument("--count", action="store_true", help="tell which hits really meet, ours and the peer's: slow")
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    return parser.parse_args()


def main() -> None:
    """Print the tables, and write them as JSON if asked."""
    arguments = parse()
    ipctk = load()
    rows = []
    print(table.HEADER)
    for step in chosen(arguments.scenes, arguments.models):
        for threads, vectors in product(arguments.threads, arguments.vectors):
            _native.limit_vector_target(VECTOR_TARGETS[vectors])
            figures = measure(step, threads, arguments.repeats, ipctk)
            rows.append(asdict(figures))
            print(table.line(figures), flush=True)
        _native.limit_vector_target(_native.best_vector_target())
        if arguments.count and ipctk:
            hits = count_hits(step, ipctk)
            rows[-1]["pairs_that_meet"] = asdict(hits)
            print(f"{'':18} {hits}")
    sizes = growth.all_sizes(1, arguments.repeats) if GROWTH in arguments.scenes else []
    for size in sizes:
        print(
            f"growth: {size.triangles:9,} triangles, {size.hits:7,} hits, {size.first:8.1f} ms,"
            f" {size.megabytes:6.0f} MB ({size.before:.0f} MB before)"
        )
    if sizes:
        print(f"growth: time as triangles to the power of {growth.exponent(sizes):.2f}")
    if arguments.json:
        content = {"steps": rows, "growth": [asdict(size) for size in sizes]}
        arguments.json.write_text(json.dumps(content, indent=2) + "\n")


if __name__ == "__main__":
    main()
