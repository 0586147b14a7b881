# SPDX-License-Identifier: GPL-3.0-or-later
"""Ten thousand drags in the scenes of the ogre's dressing, with the exact test after each move.

    python tests/long/soak.py [--drags 10000] [--moves 2] [--seeds 1] [--json F]

Each stage of the dressing has one session for the whole run. Blocks of random drags alternate with a constant
block from the same start. The results of the constant block must be identical each time. Its processor time in
the last fifth shows whether edits become slower. New processes run it in between for comparison, since the speed
of a machine varies within minutes. The memory after it is a sample: what is resident, as in a session that
nobody measures, what of it the allocator has not freed, and what is allocated.

Growth is that of the median of nine samples. The first nine follow a warm-up of 1,080 drags, the last nine
are --drags later. Each seed runs in a process of its own.

The exit code is 1 if surfaces intersect, if a constant block differs, or if it becomes slower by 10 % or more.
It is also 1 if resident or allocated memory grows by 0.5 % or more. Needs /proc and glibc 2.33.
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import numpy as np
from process_memory import WINDOW, Memory, growth, medians, memory_after

import stiv
from blend_fixtures.scenes.sessions import dressing
from blend_fixtures.scenes.sessions.session import Stage

BLOCK = 60  # drags, over all stages in turn
WARM_UP = 9  # samples before the first that count
NEW_PROCESSES, NEW_BLOCKS = 4, 4  # in the last fifth, and the constant blocks in each
LONGEST = 0.05  # of a drag, in diagonals of the movable surface
MOST_GROWTH, MOST_DRIFT = 0.005, 0.10


@dataclass
class Scene:
    """A stage of the dressing, its session, and the initial controls of each block."""

    stage: Stage
    session: stiv.EditSession
    start: np.ndarray
    diagonal: float


@dataclass
class Account:
    """Recorded results."""

    drags: int = 0
    intersections: int = 0
    statuses: dict[str, int] = field(default_factory=dict)
    memory: list[Memory] = field(default_factory=list)  # after each repeated block
    repeated_seconds: list[float] = field(default_factory=list)
    new_seconds: list[float] = field(default_factory=list)  # of constant blocks in new processes
    repeated_results: set[str] = field(default_factory=set)


def scenes() -> list[Scene]:
    """All stages, with controls at the end of the dressing, in contact."""
    found, stages = [], dressing.session().stages()
    stage = next(stages)
    while True:
        session = stiv.EditSession(
            stage.surface, stage.deformation, stage.controls, stiv.EditOptions(threads=1, **stage.options)
        )
        for edit in stage.edits:
            session.edit(edit(session.controls))
        mobile = stage.deformation.surface(stage.controls) != session.surface
        extent = np.ptp(session.surface[mobile.any(axis=1)], axis=0)
        found.append(Scene(stage, session, session.controls, float(np.linalg.norm(extent))))
        try:
            stage = stages.send(session.controls)
        except StopIteration:
            return found


def random_goal(chance: np.random.Generator, scene: Scene) -> np.ndarray:
    """Controls around a random one moved with falloff; a rigid body moved and rotated."""
    goal = scene.session.controls
    shift = chance.normal(size=3)
    shift *= chance.uniform(0, LONGEST) * scene.diagonal / np.linalg.norm(shift)
    if len(goal) == 2:
        return goal + np.array([shift, chance.normal(scale=0.05, size=3)])
    away = np.linalg.norm(goal - goal[chance.integers(len(goal))], axis=1)
    falloff = chance.choice([all_follow, only_near_follow])
    return goal + falloff(away / (chance.uniform(0.05, 0.5) * scene.diagonal))[:, None] * shift


def all_follow(away: np.ndarray) -> np.ndarray:
    """Falloff at a distance in radii that never reaches zero."""
    return np.exp(-(away**2))


def only_near_follow(away: np.ndarray) -> np.ndarray:
    """Falloff at a distance in radii that is zero beyond the radius, as in proportional editing."""
    near = np.maximum(1 - away, 0)
    return near * near * (3 - 2 * near)


def drag(scene: Scene, chance: np.random.Generator, moves: int, account: Account) -> None:
    """One drag in a few moves; each result is tested."""
    begin = scene.session.controls
    goal = random_goal(chance, scene)
    for move in range(1, moves + 1):
        result = scene.session.drag(begin + move / moves * (goal - begin))
        account.intersections += len(stiv.find_intersections(result.surface, scene.stage.surface))
        account.statuses[result.status] = account.statuses.get(result.status, 0) + 1
    account.drags += 1


def block(all_scenes: list[Scene], seed: list[int], moves: int, account: Account) -> tuple[float, str]:
    """One block from the start: processor seconds, and a hash of the result."""
    chance, begin = np.random.default_rng(seed), time.process_time()
    for scene in all_scenes:
        scene.session.restore(scene.start)
    for number in range(BLOCK):
        drag(all_scenes[number % len(all_scenes)], chance, moves, account)
    ends = hashlib.sha256(b"".join(scene.session.surface.tobytes() for scene in all_scenes))
    return time.process_time() - begin, ends.hexdigest()


def constant_blocks(moves: int) -> list[tuple[float, str]]:
    """Constant blocks in new sessions: processor seconds, and a hash of the result."""
    all_scenes = scenes()
    return [block(all_scenes, [0], moves, Account()) for _ in range(NEW_BLOCKS)]


def constant_blocks_of_new_process(moves: int) -> list[tuple[float, str]]:
    """The same in a process of its own, which leaves no trace in this one's memory."""
    command = [sys.executable, __file__, "--only-constant-blocks", "--moves", str(moves)]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return [(seconds, ends) for seconds, ends in json.loads(printed)]


def run(seed: int, drags: int, moves: int) -> Account:
    """Run blocks until the two windows of samples are this many drags apart."""
    account, all_scenes = Account(), scenes()
    samples = WARM_UP + WINDOW + max(-(-drags // (2 * BLOCK)), WINDOW)
    beside_new = np.linspace(samples - last_fifth(samples), samples - 1, NEW_PROCESSES).astype(int)
    for number in range(samples):
        block(all_scenes, [seed, number], moves, account)
        repeated = [block(all_scenes, [0], moves, account)]
        account.repeated_seconds.append(repeated[0][0])
        account.memory.append(memory_after(account.drags))
        if number in beside_new:
            repeated += constant_blocks_of_new_process(moves)
            account.new_seconds += [seconds for seconds, _ in repeated[1:]]
        account.repeated_results.update(ends for _, ends in repeated)
        print(f"seed {seed}: {report_line(account.memory[-1])}, {repeated[0][0]:.2f} s", flush=True)
    return account


def report_line(memory: Memory) -> str:
    """A line of the report."""
    sizes = (memory.resident / 1e6, memory.used / 1e6, memory.allocated / 1e6)
    return f"{memory.drags} drags: " + "{:.2f} MB resident, {:.2f} without free pages, {:.2f} allocated".format(*sizes)


def last_fifth(samples: int) -> int:
    """Number of samples in the last fifth."""
    return max(1, samples // 5)


def drift_of_time(account: Account) -> float:
    """Least time of the constant block in the last fifth, relative to that in new processes at the same time.

    Other programs only add time.
    """
    seconds = account.repeated_seconds
    return min(seconds[-last_fifth(len(seconds)) :]) / min(account.new_seconds) - 1


def figures(seed: int, account: Account) -> dict[str, Any]:
    """The account of a seed as numbers."""
    first, last = medians(account.memory[WARM_UP:][:WINDOW]), medians(account.memory[-WINDOW:])
    return {
        "seed": seed,
        "drags": account.drags,
        "drags_between": last.drags - first.drags,
        "statuses": dict(sorted(account.statuses.items())),
        "intersections": account.intersections,
        "different_ends": len(account.repeated_results) - 1,
        "drift_of_time": drift_of_time(account),
        "memory": [vars(first), vars(last)],
        "growth": {kind: growth(first, last, kind) for kind in ("resident", "used", "allocated")},
        "largest": max(each.resident for each in account.memory),
    }


def measured(seed: int, drags: int, moves: int) -> dict[str, Any]:
    """The figures of one seed."""
    return figures(seed, run(seed, drags, moves))


def is_steady(row: dict[str, Any]) -> bool:
    """Did nothing intersect, differ, slow down or grow?"""
    grows = max(row["growth"]["resident"], row["growth"]["allocated"]) >= MOST_GROWTH
    return not (row["intersections"] or row["different_ends"] or grows or row["drift_of_time"] >= MOST_DRIFT)


def parser(description: str) -> argparse.ArgumentParser:
    """The command line of every soak test."""
    found = argparse.ArgumentParser(description=description)
    found.add_argument("--drags", type=int, default=10_000)
    found.add_argument("--moves", type=int, default=2, help="mouse moves a drag (default 2)")
    return found


def main() -> int:
    """Drag, test and compare."""
    arguments = parser(__doc__.splitlines()[0])
    arguments.add_argument("--seeds", type=int, nargs="+", default=[1])
    arguments.add_argument("--json", type=Path, help="file to write the figures to")
    arguments.add_argument("--only-constant-blocks", action="store_true", help="print their seconds and results")
    chosen = arguments.parse_args()
    if chosen.only_constant_blocks:
        print(json.dumps(constant_blocks(chosen.moves)))
        return 0
    count = min(len(chosen.seeds), os.cpu_count() or 1)
    with ProcessPoolExecutor(count, get_context("spawn"), max_tasks_per_child=1) as processes:
        rows = [*processes.map(partial(measured, drags=chosen.drags, moves=chosen.moves), chosen.seeds)]
    for row in rows:
        print(json.dumps(row))
        print(*(report_line(Memory(**each)) for each in row["memory"]), sep="\n")
        print(", ".join(f"{kind} {100 * value:+.2f} %" for kind, value in row["growth"].items()))
    if chosen.json:
        chosen.json.write_text(json.dumps({"rows": rows}, indent=2) + "\n", encoding="utf-8")
    return int(not all(map(is_steady, rows)))


if __name__ == "__main__":
    raise SystemExit(main())
