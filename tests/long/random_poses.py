# SPDX-License-Identifier: GPL-3.0-or-later
"""Random rotations of random bones of a small character among boxes, each tested exactly and independently.

    python tests/long/random_poses.py [--poses 500]

It needs Blender as a module. A pose that intersects is printed with its number.
"""

import argparse
import sys
import time
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS), str(TESTS / "blender"), str(TESTS / "blender/edit")]

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from test_posing import among_boxes, count_intersections, pose_at_random  # noqa: E402


def main() -> None:
    """Pose the character at random."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--poses", type=int, default=500)
    poses, begin = parser.parse_args().poses, time.process_time()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    random, statuses, failures = np.random.default_rng(11), [], 0
    rig, body, obstacles = among_boxes()
    for number in range(poses):
        status, message = pose_at_random(random, rig)
        statuses.append(status)
        found = count_intersections(body, obstacles)
        if found or message:
            failures += 1
            print(f"pose {number}: {found} intersections; {message}")
    counts = ", ".join(f"{statuses.count(each)} {each}" for each in sorted(set(statuses)))
    print(f"{poses} poses ({counts}), {failures} failures, {time.process_time() - begin:.0f} s of processor time")
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
