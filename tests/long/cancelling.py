# SPDX-License-Identifier: GPL-3.0-or-later
"""Cancels edits of 75,592 faces at random moments, and tells how long each took to come back.

    python tests/long/cancelling.py [--times 200] [--seed 1]

Ends with 1 if a cancelled edit left anything behind. Other work on the machine adds to wall times; the processor time
that this process used in the meantime, with one thread, tells what the code itself takes.
"""

import argparse
import sys
import threading
import time
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS / "faults")]

import numpy as np  # noqa: E402
from ball_above_wall import session  # noqa: E402

import stiv  # noqa: E402

SHIFT = (0.02, 0.01, -0.45)


def main() -> int:
    """Cancels, compares, prints the delays."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--times", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1)
    chosen = parser.parse_args()
    chance, editing = np.random.default_rng(chosen.seed), session(chosen.threads)
    controls, surface = editing.controls, editing.surface
    goal = controls + SHIFT
    duration = editing.drag(goal).timings["total"]
    editing.restore(controls)
    delays, changed = [], 0
    for _ in range(chosen.times):
        token, asked = stiv.CancelToken(), []

        def cancel(token=token, asked=asked) -> None:
            asked.append((time.perf_counter(), time.process_time()))
            token.cancel()

        timer = threading.Timer(chance.uniform(0, duration), cancel)
        timer.start()
        result = editing.drag(goal, cancel=token)
        back = time.perf_counter(), time.process_time()
        timer.cancel()
        if result.status == "cancelled":
            delays.append([1000 * (after - before) for before, after in zip(asked[0], back, strict=True)])
            changed += not (np.array_equal(editing.controls, controls) and np.array_equal(editing.surface, surface))
        else:
            editing.restore(controls)
    print(f"{len(delays)} of {chosen.times} were cancelled before they ended (a whole edit takes {duration:.1f} s)")
    for name, column in (("wall", 0), ("processor", 1)):
        median, slow, worst = np.percentile(np.array(delays)[:, column], [50, 95, 100])
        print(f"back after {median:.1f} ms of {name} time (median), {slow:.1f} ms (95 %), {worst:.1f} ms (worst)")
    print(f"{changed} left a trace")
    return int(changed > 0)


if __name__ == "__main__":
    raise SystemExit(main())
