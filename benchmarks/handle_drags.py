# SPDX-License-Identifier: GPL-3.0-or-later
"""Drags of an as-rigid-as-possible ball into a sheet, on one thread: the longest drag and the median.

`python -m benchmarks.handle_drags [--drags N]`: the lower cap is the handle, the upper cap is fixed. First 20
drags go straight down, then N (500) toward random positions, in a new session. Prints processor seconds and
rounds.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

import stiv
from blend_fixtures.scenes.primitives import grid, icosphere, triangulated
from blend_fixtures.scenes.shape import joined

Floats = NDArray[np.float64]
STRIDE = 0.075  #: of the straight drags
FURTHEST = 0.15  #: step of a random drag, along each axis


def ball_above_sheet() -> tuple[stiv.EditSession, stiv.Surface, Floats]:
    """A session, its surface, and the handles at rest."""
    ball, sheet = icosphere(3), triangulated(grid(10, 10, 6, 6)).moved((0, 0, -2))
    whole, count = joined([ball, sheet]), len(ball.vertices)
    bodies = [stiv.Body("ball"), stiv.Body("sheet", "fixed")]
    owner = np.repeat([0, 1], [count, len(sheet.vertices)])
    surface = stiv.Surface(whole.triangles(), len(whole.vertices), vertex_body=owner, bodies=bodies)
    z = ball.vertices[:, 2]
    handles = np.flatnonzero(z < -0.8)
    moved = stiv.arap(ball.vertices, ball.triangles(), handles, fixed=np.flatnonzero(z > 0.8))
    deformation = stiv.concatenate([(moved, np.arange(count))], whole.vertices)
    start = ball.vertices[handles]
    return stiv.EditSession(surface, deformation, start, stiv.EditOptions(threads=1)), surface, start


def straight_offsets(count: int = 20) -> Iterator[Floats]:
    """Offsets of the handles, down through the sheet."""
    for k in range(count):
        yield np.array([0, 0, -STRIDE * (k + 1)])


def random_offsets(count: int, seed: int = 4) -> Iterator[Floats]:
    """Steps toward consecutive random positions, most of them below the sheet."""
    chance, offset = np.random.default_rng(seed), np.zeros(3)
    for _ in range(count):
        target = np.array([*chance.uniform(-0.6, 0.6, 2), chance.uniform(-1.6, -0.6)])
        offset = offset + np.clip(target - offset, -FURTHEST, FURTHEST)
        yield offset


def print_row(name: str, offsets: Iterator[Floats]) -> None:
    """Drag, and print the cost of the drags."""
    session, surface, start = ball_above_sheet()
    seconds, rounds, energy = [], [], []
    for offset in offsets:
        begin = time.process_time()
        result = session.drag(start + offset)
        seconds.append(time.process_time() - begin)
        rounds.append(result.rounds)
        energy.append(result.energy)
        assert len(stiv.find_intersections(result.surface, surface)) == 0
    took, touching = np.array(seconds), np.array(rounds) > 0
    print(
        f"{name:8} {len(took):5d} {touching.sum():8d} {np.median(took):8.3f} {np.median(took[touching]):8.3f} "
        f"{took.max():8.3f} {np.median(np.array(rounds)[touching]):7.0f} {max(rounds):7d} {sum(energy):8.3f}",
        flush=True,
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--drags", type=int, default=500, help="number of random drags")
    arguments = parser.parse_args()
    print(f"{'drags':8} {'all':>5} {'touching':>8} {'median s':>8} {'touching':>8} {'longest':>8}", end="")
    print(f" {'rounds':>7} {'most':>7} {'energy':>8}")
    print_row("straight", straight_offsets())
    print_row("random", random_offsets(arguments.drags))


if __name__ == "__main__":
    main()
