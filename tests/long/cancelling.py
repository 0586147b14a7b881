# SPDX-License-Identifier: GPL-3.0-or-later
"""Cancels edits of 75,592 faces from another thread at random moments, and tells how long each took to come back.

    python tests/long/cancelling.py [--times 200] [--seed 1] [--threads 1]

A drag, an edit, and what is left of a drag that was confirmed (settle), in turn; a third of them is cancelled by the
progress callback instead. Ends with 1 if a cancelled call changed a bit of controls or surface, if a session that was
cancelled so often gives another result than one that never was, or if a call took more than 100 ms of processor time to
come back. Other work on the machine adds to wall times; the processor time that this process used in the meantime,
with one thread, tells what the code itself takes.
"""

import argparse
import hashlib
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS / "faults")]

import numpy as np  # noqa: E402
from ball_above_wall import session  # noqa: E402

import stiv  # noqa: E402

SHIFT = (0.02, 0.01, -0.45)
MOST = 100.0  # milliseconds
CALLS: dict[str, Callable[..., stiv.EditResult]] = {
    "drag": lambda editing, goal, **execution: editing.drag(goal, **execution),
    "edit": lambda editing, goal, **execution: editing.edit(goal, **execution),
    "settle": lambda editing, goal, **execution: editing.settle(**execution),
}


@dataclass
class Moment:
    """When somebody asks to cancel, in seconds from now; `asked`: both clocks when it was done."""

    after: float
    token: stiv.CancelToken
    asked: tuple[float, float] | None = None

    def ask(self) -> None:
        self.asked = clocks()
        self.token.cancel()

    def ask_if_due(self, begin: float) -> None:
        """For progress callbacks."""
        if self.asked is None and time.perf_counter() - begin >= self.after:
            self.ask()


def clocks() -> tuple[float, float]:
    """Seconds of wall and processor time."""
    return time.perf_counter(), time.process_time()


def digest(editing: stiv.EditSession) -> str:
    """Of all that a session shows."""
    return hashlib.sha256(editing.controls.tobytes() + editing.surface.tobytes()).hexdigest()


def begin(editing: stiv.EditSession, name: str, start: np.ndarray, goal: np.ndarray) -> None:
    """The state from which a call is made: for `settle` the start with the goal still to be reached."""
    editing.restore(start, goal if name == "settle" else start)


def cancelled(editing: stiv.EditSession, name: str, goal: np.ndarray, moment: Moment, by_progress: bool) -> str:
    """Status of a call that is cancelled at a moment."""
    execution = {"cancel": moment.token}
    if by_progress:
        begun = time.perf_counter()
        return CALLS[name](editing, goal, progress=lambda *_: moment.ask_if_due(begun), **execution).status
    timer = threading.Timer(moment.after, moment.ask)
    timer.start()
    try:
        return CALLS[name](editing, goal, **execution).status
    finally:
        timer.cancel()


def main() -> int:
    """Cancels, compares, prints the delays."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--times", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    chosen = parser.parse_args()
    chance, editing, undisturbed = np.random.default_rng(chosen.seed), *(session(chosen.threads) for _ in range(2))
    start = editing.controls
    goal = start + SHIFT
    durations, wanted = {}, {}
    for name, call in CALLS.items():
        begin(undisturbed, name, start, goal)
        durations[name] = call(undisturbed, goal).timings["total"]
        wanted[name] = digest(undisturbed)
    delays, changed, number = [], 0, 0
    while len(delays) < chosen.times:
        name, by_progress = list(CALLS)[number % 3], number // 3 % 3 == 2
        number += 1
        begin(editing, name, start, goal)
        before = digest(editing)
        moment = Moment(chance.uniform(0, durations[name]), stiv.CancelToken())
        status = cancelled(editing, name, goal, moment, by_progress)
        if status == "cancelled":
            delays.append([1000 * (after - asked) for after, asked in zip(clocks(), moment.asked, strict=True)])
            changed += digest(editing) != before
    different = 0
    for name, call in CALLS.items():
        begin(editing, name, start, goal)
        call(editing, goal)
        different += digest(editing) != wanted[name]
    whole = ", ".join(f"{name} {seconds:.1f} s" for name, seconds in durations.items())
    print(f"{len(delays)} calls cancelled, {number - len(delays)} more had ended before ({whole} when left alone)")
    for name, column in (("wall", 0), ("processor", 1)):
        median, slow, worst = np.percentile(np.array(delays)[:, column], [50, 95, 100])
        print(f"back after {median:.1f} ms of {name} time (median), {slow:.1f} ms (95 %), {worst:.1f} ms (worst)")
    late = [sum(delay > MOST for delay in column) for column in zip(*delays, strict=True)]
    print(f"{late[0]} came back later than {MOST:.0f} ms of wall time, {late[1]} of processor time")
    print(f"{changed} left a trace, {different} of {len(CALLS)} results differ from an undisturbed session's")
    return int(changed > 0 or different > 0 or late[1] > 0)


if __name__ == "__main__":
    raise SystemExit(main())
