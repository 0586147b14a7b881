# SPDX-License-Identifier: GPL-3.0-or-later
"""Cancel edits of 75,592 faces from another thread at random moments, and measure the response times.

    python tests/long/cancelling.py [--times 200] [--seed 1] [--threads 1]

It alternates between drags, edits and settling; the progress callback cancels a third of them. The exit code
is 1 in three cases: a cancelled call changed a bit of the controls or the surface, the cancelled session
later gives other results than an uncancelled one, or a call took more than 100 ms of processor time to
return. Other programs add to wall times; with one thread, the processor time of this process shows the cost
of the code itself.
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
    """The time of a cancel request, in seconds from now; `asked`: both clocks at the request."""

    after: float
    token: stiv.CancelToken
    asked: tuple[float, float] | None = None

    def ask(self) -> None:
        self.asked = clocks()
        self.token.cancel()

    def ask_if_due(self, begin: float) -> None:
        """Request it if it is due, in progress callbacks."""
        if self.asked is None and time.perf_counter() - begin >= self.after:
            self.ask()


def clocks() -> tuple[float, float]:
    """Seconds of wall and processor time."""
    return time.perf_counter(), time.process_time()


def digest(editing: stiv.EditSession) -> str:
    """Digest of the visible state of a session."""
    return hashlib.sha256(editing.controls.tobytes() + editing.surface.tobytes()).hexdigest()


def begin(editing: stiv.EditSession, name: str, start: np.ndarray, goal: np.ndarray) -> None:
    """Prepare the state before a call: for `settle`, the start with a pending goal."""
    editing.restore(start, goal if name == "settle" else start)


def cancelled(editing: stiv.EditSession, name: str, goal: np.ndarray, moment: Moment, by_progress: bool) -> str:
    """Status of a call cancelled at this moment."""
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
    """Cancel, compare and print the delays."""
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
