# SPDX-License-Identifier: GPL-3.0-or-later
"""Random rotations of random bones of a small character among boxes, each tested exactly and independently.

    python tests/long/random_poses.py [--poses 500] [--drag]

It needs Blender as a module. A pose that intersects is printed with its number. --drag: the poses are dragged in
twenty motions of the mouse, each with the time of a frame, and every fifth written state is tested.
"""

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS), str(TESTS / "blender"), str(TESTS / "blender/edit")]

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from building import turn  # noqa: E402
from test_posing import SETTINGS, among_boxes, count_intersections, pose_at_random, random_rotation  # noqa: E402

from stiv.blender import BlenderEdit, Motion, kept_twins  # noqa: E402

MOTIONS, BUDGET = 20, 0.038  # of a drag, and seconds of a solve


def main() -> None:
    """Pose the character at random."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--poses", type=int, default=500)
    parser.add_argument("--drag", action="store_true")
    arguments, begin = parser.parse_args(), time.process_time()
    poses = arguments.poses
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    random, statuses, failures = np.random.default_rng(11), [], 0
    rig, body, obstacles = among_boxes()
    for number in range(poses):
        if arguments.drag:
            status, message, found = drag_at_random(random, rig, lambda: count_intersections(body, obstacles))
        else:
            status, message = pose_at_random(random, rig)
            found = count_intersections(body, obstacles)
        statuses.append(status)
        if found or message:
            failures += 1
            print(f"pose {number}: {found} intersections; {message}")
    counts = ", ".join(f"{statuses.count(each)} {each}" for each in sorted(set(statuses)))
    print(f"{poses} poses ({counts}), {failures} failures, {time.process_time() - begin:.0f} s of processor time")
    sys.exit(failures > 0)


def drag_at_random(
    random: np.random.Generator, rig: bpy.types.Object, count: Callable[[], int]
) -> tuple[str, str, int]:
    """Drag a random bone: the last status, why a state could not be written, and the intersections of all states."""
    head, axis, angle = random_rotation(random, rig)
    message, found = "", 0
    with kept_twins():
        edit = BlenderEdit.begin(bpy.context, SETTINGS, "rotate")
        for number in range(1, MOTIONS + 1):
            matrix = turn(angle * number / MOTIONS, axis, head)
            result = edit.drag(Motion(matrix, head), time_budget=BUDGET)
            report = edit.write()
            message = message or ("" if report.passed else report.message)
            found += count() if number % 5 == 0 else 0
    return result.status, message, found


if __name__ == "__main__":
    main()
