# SPDX-License-Identifier: GPL-3.0-or-later
"""Random steps of editing sessions, each checked, up to the given number.

    python tests/long/random_sessions.py [--steps 20000]

Hypothesis shrinks a failure to the fewest steps and prints it.
"""

import argparse
import sys
import time
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS / "editing")]

from hypothesis import HealthCheck, settings  # noqa: E402
from hypothesis.stateful import run_state_machine_as_test  # noqa: E402
from random_session import RandomSession  # noqa: E402

SETTINGS = settings(max_examples=100, stateful_step_count=100, deadline=None, suppress_health_check=list(HealthCheck))


def main() -> None:
    """Run random sessions."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=20_000)
    steps, begin = parser.parse_args().steps, time.process_time()
    while RandomSession.done < steps:
        run_state_machine_as_test(RandomSession, settings=SETTINGS)
    print(f"{RandomSession.done} steps, 0 intersections, {time.process_time() - begin:.0f} s of processor time")


if __name__ == "__main__":
    main()
