# SPDX-License-Identifier: GPL-3.0-or-later
"""The increments of a drag's size in which a typed value is approached."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from stiv.blender.controls.motion import Motion
from stiv.blender.edit.transform_path import Path, increments, transform_at
from stiv.blender.scene.arrays import Floats

LONGEST = 0.02  # increment, in diagonals of what moves
MOST = 200  # increments of one value


def motions_toward(target: Motion, path: Path | None, points: Floats) -> Iterator[Motion]:
    """Motions of an edit, the target last, of which none takes a point, (n, 3), much farther than a drag would.

    path: the way to the target's matrix, for what that cannot tell (more than half a turn); None: the shortest.
    """
    way: Path = path or (lambda fraction: transform_at(target.matrix, fraction))
    diagonal = float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0
    count = increments(way, points, LONGEST * diagonal, MOST)
    for step in range(1, count):
        fraction = step / count
        rotation = None if target.rotation is None else fraction * target.rotation
        motion = replace(target, matrix=way(fraction), rotation=rotation)
        if np.linalg.det(motion.linear):  # else flat for a moment, on the way to a mirror image
            yield motion
    yield target
