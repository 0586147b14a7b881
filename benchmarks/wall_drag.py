# SPDX-License-Identifier: GPL-3.0-or-later
"""A box and a faceted sphere dragged along a wall while the mouse moves 2 units into it, and back.

Prints the travel along the wall, the sideways drift, the distance from the wall while the mouse is inside,
and the final distance from the start. `python -m benchmarks.wall_drag [--json FILE]`
"""

from __future__ import annotations

import argparse
import json
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import stiv
from blend_fixtures.scenes.primitives import box, grid, icosphere, triangulated
from blend_fixtures.scenes.shape import Shape, joined

MOVES = 100
DEPTH = 2.0


@dataclass(frozen=True)
class WallDrag:
    """Result of a drag along a wall; lengths in world units."""

    shape: str
    travel: float  #: along the wall, of the mouse's 2.0
    drift: float  #: largest sideways motion
    gap_at_wall: float  #: largest height above the wall while the mouse was inside it
    return_error: float  #: largest distance from the start at the end, over all vertices
    free_at_end: float  #: height above the wall when the mouse is back at its start
    rounds_a_move: float
    intersections: int  #: pairs of triangles, summed over all states


def shapes() -> dict[str, Shape]:
    """The two shapes, 0.2 above the wall."""
    return {
        "box": triangulated(box(4, (1, 1, 1))).moved((0.0137, 0.0071, 0.7)),
        "sphere": icosphere(2, 0.5).moved((0.0137, 0.0071, 0.7)),
    }


def goals() -> NDArray[np.float64]:
    """Offsets of the mouse, (200, 3): along and into the wall, then straight back."""
    steps = np.arange(1, MOVES + 1) / MOVES
    there = np.stack([DEPTH * steps, 0 * steps, -DEPTH * steps], axis=1)
    back = np.stack([DEPTH + 0 * steps, 0 * steps, -DEPTH * (1 - steps)], axis=1)
    return np.concatenate([there, back])


def drag_along_wall(name: str) -> WallDrag:
    """Drag one of the shapes, and measure."""
    mover, wall = shapes()[name], triangulated(grid(23, 23, 6, 6))
    count = len(mover.vertices)
    scene = joined([mover, wall])
    surface = stiv.Surface(
        scene.triangles(),
        vertex_count=len(scene.vertices),
        vertex_body=np.repeat([0, 1], [count, len(wall.vertices)]),
        bodies=[stiv.Body(name, "rigid"), stiv.Body("wall", "fixed")],
    )
    deformation = stiv.concatenate([(stiv.rigid(mover.vertices), np.arange(count))], scene.vertices)
    start = stiv.rigid_rest_controls(mover.vertices)
    session = stiv.EditSession(surface, deformation, start)
    rounds = intersections = 0
    drift = gap = travel = 0.0
    for number, offset in enumerate(goals()):
        result = session.drag(start + [offset, [0, 0, 0]])
        rounds += result.rounds
        intersections += len(stiv.find_intersections(result.surface, surface))
        moved = result.controls[0] - start[0]
        drift = max(drift, abs(moved[1]))
        if number == MOVES - 1:
            travel = moved[0]
        if offset[2] < -0.25:
            contact = number >= 20  # a few moves after the first contact
            gap = max(gap, result.surface[:count, 2].min() if contact else 0.0)
    expected = mover.vertices + goals()[-1]
    error = float(np.abs(result.surface[:count] - expected).max())
    height = float(result.surface[:count, 2].min())
    return WallDrag(name, float(travel), drift, float(gap), error, height, rounds / len(goals()), intersections)


def main() -> None:
    """Print the table, and optionally write it as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--json", type=Path, help="file to write the figures to")
    arguments = parser.parse_args()
    results = [drag_along_wall(name) for name in shapes()]
    print(f"{'shape':8} {'travel':>8} {'drift':>8} {'gap':>8} {'return':>9} {'rounds/move':>11} {'intersections':>13}")
    for r in results:
        print(
            f"{r.shape:8} {r.travel:8.4f} {r.drift:8.5f} {r.gap_at_wall:8.5f} {r.return_error:9.2g}"
            f" {r.rounds_a_move:11.2f} {r.intersections:13d}"
        )
    if arguments.json:
        arguments.json.write_text(json.dumps([asdict(r) for r in results], indent=2) + "\n")


if __name__ == "__main__":
    main()
