# SPDX-License-Identifier: GPL-3.0-or-later
"""Ten thousand drags in the scenes of the ogre's dressing, with the exact test after each move.

    python tests/long/soak.py [--drags 10000] [--moves 2] [--seed 1]

Each stage of the dressing has one session for the whole run. Blocks of random drags alternate with a constant
block from the same start. The results of the constant block must be identical each time. Its processor time
shows whether edits become slower, and the bytes allocated after it show whether memory leaks. The resident
memory of the process is reported after the first pass over all stages, after the first tenth, and at the end:
with the free pages that the allocator keeps, which grow with the largest edit so far, and after it returned
them.

The exit code is 1 if surfaces intersect, if a constant block differs, or if it becomes slower by 10 % or more.
It is also 1 if the bytes allocated, or the resident ones without free pages, grow by 0.5 % or more after the
first tenth. Needs /proc, malloc_trim and mallinfo2 (glibc 2.33).
"""

import argparse
import ctypes
import gc
import hashlib
import os
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

import numpy as np

import stiv
from blend_fixtures.scenes.sessions import dressing
from blend_fixtures.scenes.sessions.session import Stage

BLOCK = 60  # drags, over all stages in turn
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
class Memory:
    """Bytes after this many drags: resident, resident without the allocator's free pages, and allocated."""

    drags: int
    resident: int
    used: int
    allocated: int


class AllocatorState(ctypes.Structure):
    """The result of mallinfo2 for the main thread, in the order of malloc.h; the sessions use one thread."""

    _fields_ = (
        *((name, ctypes.c_size_t) for name in ("arena", "ordblks", "smblks", "hblks")),
        *((name, ctypes.c_size_t) for name in ("hblkhd", "usmblks", "fsmblks", "uordblks", "fordblks", "keepcost")),
    )


@dataclass
class Account:
    """Recorded results."""

    drags: int = 0
    intersections: int = 0
    statuses: dict[str, int] = field(default_factory=dict)
    memory: list[Memory] = field(default_factory=list)  # after each repeated block
    repeated_seconds: list[float] = field(default_factory=list)
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


def block(all_scenes: list[Scene], seed: int, moves: int, account: Account) -> tuple[float, str]:
    """One block from the start: processor seconds, and a hash of the result."""
    chance, begin = np.random.default_rng(seed), time.process_time()
    for scene in all_scenes:
        scene.session.restore(scene.start)
    for number in range(BLOCK):
        drag(all_scenes[number % len(all_scenes)], chance, moves, account)
    ends = hashlib.sha256(b"".join(scene.session.surface.tobytes() for scene in all_scenes))
    return time.process_time() - begin, ends.hexdigest()


def memory_after(drags: int) -> Memory:
    """Memory in use after a garbage collection, which frees the random generators."""
    gc.collect()
    allocator = ctypes.CDLL(None)
    allocator.mallinfo2.restype = AllocatorState
    state, with_free_pages = allocator.mallinfo2(), resident()
    allocator.malloc_trim(0)
    return Memory(drags, with_free_pages, resident(), state.uordblks + state.hblkhd)


def resident() -> int:
    """Resident bytes of the process."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE")


def run(drags: int, seed: int, moves: int) -> Account:
    """Run blocks up to this number of drags."""
    account, all_scenes = Account(), scenes()
    while account.drags < drags:
        block(all_scenes, seed, moves, account)
        seed += 1
        seconds, ends = block(all_scenes, 0, moves, account)
        account.repeated_seconds.append(seconds)
        account.repeated_results.add(ends)
        account.memory.append(memory_after(account.drags))
        print(f"{report_line(account.memory[-1])}, {seconds:.2f} s", flush=True)
    return account


def report_line(memory: Memory) -> str:
    """A line of the report."""
    sizes = (memory.resident / 1e6, memory.used / 1e6, memory.allocated / 1e6)
    return f"{memory.drags} drags: " + "{:.2f} MB resident, {:.2f} without free pages, {:.2f} allocated".format(*sizes)


def growth_of_memory(account: Account) -> float:
    """Growth from the first tenth to the end, for the kind of memory that grew more."""
    settled, end = account.memory[settled_by(account)], account.memory[-1]
    return max(end.used / settled.used, end.allocated / settled.allocated) - 1


def settled_by(account: Account) -> int:
    """The index of the measurement after the first tenth."""
    return next(number for number, memory in enumerate(account.memory) if 10 * memory.drags >= account.drags)


def drift_of_time(account: Account) -> float:
    """Minimum time of the constant block in the last fifth relative to the first; other programs only add time."""
    count = max(1, len(account.repeated_seconds) // 5)
    return min(account.repeated_seconds[-count:]) / min(account.repeated_seconds[:count]) - 1


def arguments(description: str) -> argparse.Namespace:
    """The command line of a soak test: `drags`, `seed` and `moves`."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--drags", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--moves", type=int, default=2, help="mouse moves a drag (default 2)")
    return parser.parse_args()


def main() -> int:
    """Drag, test and compare."""
    chosen = arguments(__doc__.splitlines()[0])
    account = run(chosen.drags, chosen.seed, chosen.moves)
    growth, drift = growth_of_memory(account), drift_of_time(account)
    counts = ", ".join(f"{count} {status}" for status, count in sorted(account.statuses.items()))
    print(f"{account.drags} drags of {chosen.moves} moves ({counts}), {account.intersections} intersections")
    print(
        report_line(account.memory[0]),
        report_line(account.memory[settled_by(account)]),
        report_line(account.memory[-1]),
        sep="\n",
    )
    print(f"memory {100 * growth:+.2f} %, time {100 * drift:+.1f} %, {len(account.repeated_results)} ends of one block")
    same = len(account.repeated_results) == 1
    return int(account.intersections > 0 or not same or growth >= MOST_GROWTH or drift >= MOST_DRIFT)


if __name__ == "__main__":
    raise SystemExit(main())
