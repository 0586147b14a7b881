# SPDX-License-Identifier: GPL-3.0-or-later
"""Controls that are points: vertices of a cage, points of a lattice."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stiv.blender.arrays import Floats, Indices, Singles, transform_points
from stiv.blender.motion import Influence, Motion
from stiv.blender.nearness import distances_along, island_centres, nearest_distances

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class PointGoal:
    """The selected points, (m,), follow the transform, and those near them as far as its influence reaches.

    `start` are their world positions, (m, 3); `edges`, (e, 2), connect them, None where nothing does; `origin` is that
    of an object in Object Mode, None in Edit Mode, where each connected piece of the selection has its own.
    """

    selected: Mask
    start: Floats
    edges: Indices | None = None
    origin: Floats | None = None

    @property
    def moves(self) -> bool:
        """Is any point selected?"""
        return bool(self.selected.any())

    def goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of the points, (m, 3)."""
        goal = controls.copy()
        if motion.influence is not None:
            shares = self.shares(motion.influence)
            goal[shares > 0] = motion.shared(controls[shares > 0], shares[shares > 0])
        elif motion.individual and self.moves:
            goal[self.selected] = motion.about(controls[self.selected], self._own_origins)
        else:
            goal[self.selected] = motion.whole(controls[self.selected])
        return goal

    def reached(self, influence: Influence | None) -> Mask:
        """Which points the transform moves, (m,)."""
        return self.selected if influence is None else self.shares(influence) > 0

    def shares(self, influence: Influence) -> Floats:
        """Share of the transform of each point, (m,)."""
        if not self.moves:
            return np.zeros(len(self.selected))
        return influence.shares(self._along if influence.connected and self.edges is not None else self._straight)

    @cached_property
    def _straight(self) -> Floats:
        return nearest_distances(self.start, self.selected)

    @cached_property
    def _along(self) -> Floats:
        assert self.edges is not None
        return distances_along(self.edges, self.start, self.selected)

    @cached_property
    def _own_origins(self) -> Floats:
        if self.origin is not None:
            return self.origin
        return island_centres(self.start, self.selected, self.edges)


def point_weights(selected: Mask, of_selected: float, of_others: float) -> Floats:
    """Response weight of each point, (m,)."""
    return np.where(selected, of_selected, of_others)


def stored(frame: Floats, world: Floats) -> Singles:
    """Local coordinates, (m, 3), in single precision, of points in world space."""
    return transform_points(np.linalg.inv(frame).astype(np.float64), world).astype(np.float32)
