# SPDX-License-Identifier: GPL-3.0-or-later
"""Corrects five clips of three characters by their keyframes, and measures the written files independently.

    python tests/long/rig_clips.py [CLIP...] [--folder F]

It needs Blender as a module. All skin is tested, also at joints. The motion of the clips is made from sines of the
frame (blend_fixtures/moving_characters.py).
"""

import argparse
import sys
import tempfile
import time
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS), str(TESTS / "blender"), str(TESTS / "blender/animation")]

import bpy  # noqa: E402
import numpy as np  # noqa: E402
from test_resolve_rig import bends, findings, joint_acceleration, largest_acceleration, resolved, shapes  # noqa: E402

from blend_fixtures.moving_characters import CLIPS, make_clip  # noqa: E402

COLUMNS = ("clip", "frames", "pairs", "after", "bones", "mean", "moved", "largest", "joints", "points", "seconds")


def measure(name: str, folder: Path) -> tuple[object, ...]:
    """A row of the table."""
    make_clip(name)
    last = bpy.context.scene.frame_end
    pairs, points, poses = len(findings(last, 0.25)), shapes(last), bends(last)
    begin = time.process_time()
    report = resolved(folder, "--joint-region", "0")
    seconds = time.process_time() - begin
    turns = np.degrees(np.arccos(np.clip((np.einsum("fbij,fbij->fb", poses, bends(last)) - 1) / 2, -1, 1)))
    animated = np.abs(np.diff(poses, axis=0)).max(axis=(0, 2, 3)) > 1e-6
    mended = np.mean([frame["status"] != "failed" for frame in report["frames"]])
    return (
        name, last, pairs, len(findings(last, 0.25)), f"{100 * mended:.0f} %", f"{turns[:, animated].mean():.2f}",
        f"{turns[turns > 0.01].mean():.2f}", f"{turns.max():.1f}",
        f"{joint_acceleration(bends(last)) / joint_acceleration(poses):.2f}",
        f"{largest_acceleration(shapes(last)) / largest_acceleration(points):.2f}", f"{seconds:.1f}",
    )  # fmt: skip


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("clips", nargs="*", choices=[[], *CLIPS])
    parser.add_argument("--folder", type=Path, help="where to leave the files")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        rows = []
        for name in arguments.clips or CLIPS:
            folder = (arguments.folder or Path(temporary)) / name
            folder.mkdir(parents=True, exist_ok=True)
            rows.append(measure(name, folder))
    for row in (COLUMNS, *rows):
        print(" ".join(f"{each!s:>8}" for each in row))
    print(
        "pairs: intersecting, at quarters of frames and between them, in the input and after; bones: frames mended by"
        " bones alone; mean: change of an animated joint over all frames, degrees; moved: of the joints that changed;"
        " joints, points: largest acceleration beside that of the input"
    )
    sys.exit(any(row[3] != 0 for row in rows))


if __name__ == "__main__":
    main()
