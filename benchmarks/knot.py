# SPDX-License-Identifier: GPL-3.0-or-later
"""A knotted tube under Laplacian editing, pulled tight: its foot is fixed, its top is a handle dragged up.

Prints milliseconds per move (wall and processor time), intersections in any state, and the travel of the top.
`python -m benchmarks.knot [--threads 2] [--moves 200] [--rings 600] [--sides 10] [--json FILE]`
"""

from __future__ import annotations

import argparse
import json
import time
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

import stiv
from blend_fixtures.scenes.sweeps import trefoil


@dataclass(frozen=True)
class KnotDrag:
    """Result of dragging the top of the knot; lengths in world units."""

    triangles: int
    handles: int
    moves: int
    setup_seconds: float
    median_ms: float  #: wall time per move
    median_processor_ms: float
    slowest_ms: float
    moves_with_contact: int
    rounds: int
    blocked: int  #: moves that stopped at the last clear state
    travel: float  #: mean motion of the handles, of `asked`
    asked: float
    foot_motion: float  #: largest, of the fixed vertices
    intersections: int  #: pairs of triangles, summed over all states


def knot_session(rings: int, sides: int, threads: int) -> tuple[stiv.EditSession, np.ndarray]:
    """A session on the knot, and its fixed vertices; controls are the vertices of the top."""
    shape = trefoil(rings, sides)
    y = shape.vertices[:, 1]
    foot, top = np.flatnonzero(y < np.quantile(y, 0.12)), np.flatnonzero(y > np.quantile(y, 0.9))
    deformation = stiv.laplacian(shape.vertices, shape.triangles(), top, fixed=foot)
    options = stiv.EditOptions(threads=threads)
    return stiv.EditSession(shape.triangles(), deformation, shape.vertices[top], options), foot


def drag_knot(rings: int = 600, sides: int = 10, moves: int = 200, lift: float = 2.0, threads: int = 2) -> KnotDrag:
    """Lift the top by `lift` in `moves` moves, and measure."""
    begin = time.perf_counter()
    session, foot = knot_session(rings, sides, threads)
    setup = time.perf_counter() - begin
    triangles = trefoil(rings, sides).triangles()
    start, start_surface = session.controls, session.surface
    clock, processor, contacts, rounds, blocked, pairs = [], [], 0, 0, 0, 0
    for move in range(1, moves + 1):
        goal = start + (0, lift * move / moves, 0)
        before = time.perf_counter(), time.process_time()
        result = session.drag(goal)
        clock.append(time.perf_counter() - before[0])
        processor.append(time.process_time() - before[1])
        contacts += result.rounds > 0
        rounds += result.rounds
        blocked += result.status == "blocked"
        pairs += len(stiv.find_intersections(result.surface, triangles))
    return KnotDrag(
        triangles=len(triangles),
        handles=len(start),
        moves=moves,
        setup_seconds=setup,
        median_ms=1000 * float(np.median(clock)),
        median_processor_ms=1000 * float(np.median(processor)),
        slowest_ms=1000 * max(clock),
        moves_with_contact=contacts,
        rounds=rounds,
        blocked=blocked,
        travel=float((session.controls - start)[:, 1].mean()),
        asked=lift,
        foot_motion=float(np.abs(session.surface[foot] - start_surface[foot]).max()),
        intersections=pairs,
    )


def main() -> None:
    """Print the figures, and optionally write them as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--threads", type=int, default=2, help="threads of the core (default: 2)")
    parser.add_argument("--moves", type=int, default=200, help="mouse moves (default: 200)")
    parser.add_argument("--rings", type=int, default=600, help="rings of the tube (default: 600)")
    parser.add_argument("--sides", type=int, default=10, help="vertices of a ring (default: 10)")
    parser.add_argument("--lift", type=float, default=2.0, help="how far the top is dragged (default: 2)")
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    arguments = parser.parse_args()
    result = asdict(
        drag_knot(arguments.rings, arguments.sides, arguments.moves, arguments.lift, threads=arguments.threads)
    )
    print(json.dumps(result, indent=2))
    if arguments.json:
        arguments.json.write_text(json.dumps(result, indent=2) + "\n")


if __name__ == "__main__":
    main()
