# SPDX-License-Identifier: GPL-3.0-or-later
"""How far two triangles cut into each other, by their separating axes."""

import numpy as np


def parting_motion(one: np.ndarray, other: np.ndarray) -> float:
    """The shortest motion that parts two triangles, (3, 3) each, by separating axes."""
    sides = [np.roll(each, -1, axis=0) - each for each in (one, other)]
    normals = [np.cross(each[0], each[1]) for each in sides]
    axes = [*normals, *(np.cross(a, b) for a in sides[0] for b in sides[1])]
    axes += [np.cross(n, side) for n, each in zip(normals, sides, strict=True) for side in each]
    directions = [axis / np.linalg.norm(axis) for axis in axes if np.linalg.norm(axis) > 1e-12]
    return min(min((one @ d).max() - (other @ d).min(), (other @ d).max() - (one @ d).min()) for d in directions)
