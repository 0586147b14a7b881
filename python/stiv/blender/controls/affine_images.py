# SPDX-License-Identifier: GPL-3.0-or-later
"""Affine images of controls: the same points as several objects, or the sides of a mirror, show them."""

from collections.abc import Sequence

import numpy as np

import stiv
from stiv.blender.scene.arrays import Floats, Indices

ROUNDING = 1e-12  # relative error of a product of matrices


def affine_images(count: int, points: Sequence[Indices], maps: Sequence[Floats]) -> stiv.Deformation:
    """Deformation from `count` controls to images of some of them, (k,), under each uniform map, (4, 4), stacked."""
    anchors = np.concatenate(points).astype(np.int32)
    factors = [uniform_factor(matrix) for matrix in maps]
    rows = np.arange(len(anchors) + 1, dtype=np.int32)
    sizes = [len(each) for each in points]
    weights = stiv.Weights(rows, anchors, np.repeat(np.array(factors, np.float64), sizes), (len(anchors), count))
    return stiv.linear(weights, np.repeat([matrix[:3, 3] for matrix in maps], sizes, axis=0))


def uniform_factor(matrix: Floats) -> float | None:
    """The factor of a map that scales alike in all directions without rotation; None for any other."""
    linear = matrix[:3, :3]
    factor = float(np.trace(linear)) / 3
    return factor if np.abs(linear - factor * np.eye(3)).max() <= ROUNDING * np.abs(linear).max() else None
