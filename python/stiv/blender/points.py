# SPDX-License-Identifier: GPL-3.0-or-later
"""Controls that are points: vertices of a cage, points of a lattice."""

from dataclasses import dataclass

import numpy as np

from stiv.blender.arrays import Floats, Singles, transform_points


@dataclass(frozen=True)
class PointGoal:
    """The selected points, (k,), follow the transform; all others are to stay."""

    selected: np.ndarray[tuple[int], np.dtype[np.bool_]]

    @property
    def moves(self) -> bool:
        """Is any point selected?"""
        return bool(self.selected.any())

    def goal(self, controls: Floats, last: Floats, matrix: Floats) -> Floats:
        """Goal of the points, (m, 3)."""
        goal = controls.copy()
        goal[self.selected] = transform_points(matrix, controls[self.selected])
        return goal


def point_weights(selected: np.ndarray[tuple[int], np.dtype[np.bool_]], of_selected: float, of_others: float) -> Floats:
    """Response weight of each point, (m,)."""
    return np.where(selected, of_selected, of_others)


def stored(frame: Floats, world: Floats) -> Singles:
    """Local coordinates, (m, 3), in single precision, of points in world space."""
    return transform_points(np.linalg.inv(frame).astype(np.float64), world).astype(np.float32)
