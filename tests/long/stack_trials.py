# SPDX-License-Identifier: GPL-3.0-or-later
"""Trials of edits under modifier stacks and of kinds of data, each in three ways, and of random combinations.

    python tests/long/stack_trials.py [--edits 20] [--random 500] [--seed 1] [--step 1]

Prints each trial that was not followed, and each edit that keeps less of a motion than Blender's own Move up to the
first intersection. The exit code is 1 if there is such an edit, if fewer than 78 of the 84 trials were followed, if
anything met or was raised, or if the message of a refusal is too long. Without edits, only the random combinations are
tried. --step 3 tries every third seed. Needs Blender as a Python module.
"""

import argparse
import os
import sys
import traceback
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS), str(TESTS / "blender")]

import bpy  # noqa: E402
from stack_trials import WAYS, Outcome, kept_motion, run_random_trial, run_trial  # noqa: E402
from stacks import COMMON, KINDS, STACKS  # noqa: E402

LEAST_FOLLOWED = 78
RESOLUTION = 0.01  # of the comparison of kept motion
LONGEST = 80  # characters of a message in the status bar


def judged(trial: Callable[[], Outcome]) -> Outcome:
    """The outcome of a trial in a new file; "raised" with the last lines of a traceback."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    try:
        return trial()
    except Exception:
        return Outcome("raised", "".join(traceback.format_exc()[-600:]))


def random_trial(seed: int) -> Outcome:
    """A trial of a random combination, with its modifiers in the text."""
    outcome, names = run_random_trial(seed)
    return Outcome(outcome.verdict, f"{' '.join(names)}\n{outcome.text}")


def counted(title: str, outcomes: dict[str, Outcome]) -> Counter[str]:
    """Prints all outcomes except the followed ones, and how many there are of each kind."""
    for name, outcome in outcomes.items():
        if outcome.verdict != "followed":
            print(f"{name}: {outcome.verdict}: {outcome.text}", flush=True)
    found = Counter(outcome.verdict for outcome in outcomes.values())
    print(f"{title}: {dict(found)}", flush=True)
    return found


def losses() -> list[str]:
    """Edits that keep less of a motion than Blender's own Move up to the first intersection; prints all numbers."""
    lost = []
    for name, make in STACKS.items():
        for way in WAYS:
            bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
            kept, until_contact = kept_motion(make, way)
            print(f"{name}, {way}: kept {kept:.2f}, Blender's Move until contact {until_contact:.2f}", flush=True)
            if kept < until_contact - RESOLUTION:
                lost.append(f"{name}, {way}")
    print(f"kept less than Blender's Move: {lost}", flush=True)
    return lost


def is_bad(outcome: Outcome) -> bool:
    """Does the outcome break a promise?"""
    too_long = outcome.verdict == "refused" and len(outcome.text.rpartition("\n")[2]) > LONGEST
    return outcome.verdict in ("met", "raised") or too_long


def main() -> int:
    """Run all trials."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--edits", type=int, default=20)
    parser.add_argument("--random", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--step", type=int, default=1)
    chosen = parser.parse_args()
    trials = {
        f"{name}, {way}": judged(partial(run_trial, (STACKS | KINDS)[name], way, chosen.seed + number, chosen.edits))
        for number, name in enumerate(COMMON if chosen.edits else ())
        for way in WAYS
    }
    found = counted("stacks and kinds of data", trials)
    lost = losses() if chosen.edits else []
    seeds = range(chosen.seed, chosen.seed + chosen.random, chosen.step)
    combinations = {f"seed {seed}": judged(partial(random_trial, seed)) for seed in seeds}
    counted("random combinations", combinations)
    bad = [name for name, outcome in (trials | combinations).items() if is_bad(outcome)]
    return int(bool(bad) or bool(lost) or (bool(trials) and found["followed"] < LEAST_FOLLOWED))


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    os._exit(code)  # Blender may hang when Python exits
