# SPDX-License-Identifier: GPL-3.0-or-later
"""Controls that are points: vertices of a cage, points of a lattice."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stiv.blender.controls.location_locks import FreeDirections
from stiv.blender.controls.motion import Influence, Motion
from stiv.blender.controls.selection_distances import distances_along, island_centres, nearest_distances
from stiv.blender.scene.arrays import Flags, Floats, Indices, Singles, transform_points

ROUNDING = 1e-11  # relative error allowed for the way to the world and back, all steps of an edit together


@dataclass(frozen=True)
class PinnedDirections:
    """Points, (m,) flags, that move along the free directions only."""

    points: Flags
    directions: FreeDirections

    def limited(self, start: Floats, goal: Floats) -> Floats:
        """The goal, (m, 3), without what the pins forbid of the way from the start."""
        allowed = goal.copy()
        way = goal[self.points] - start[self.points]
        allowed[self.points] = start[self.points] + self.directions.along(way)
        return allowed


@dataclass(frozen=True)
class PointGoal:
    """The selected points, (m,), follow the transform, and those near them as far as its influence reaches.

    `start` are their world positions, (m, 3); `edges`, (e, 2), connect them, None where nothing does; `origin` is that
    of an object in Object Mode, None in Edit Mode, where each connected piece of the selection has its own; `free`,
    (m,), says which may move at all, None: all; `pinned` which of them keep to some directions, None: none.
    """

    selected: Flags
    start: Floats
    edges: Indices | None = None
    origin: Floats | None = None
    free: Flags | None = None
    pinned: PinnedDirections | None = None

    @property
    def moves(self) -> bool:
        """Is any point selected?"""
        return bool(self.selected.any())

    def goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of the points, (m, 3)."""
        goal = self._unlimited(controls, motion)
        return goal if self.pinned is None else self.pinned.limited(controls, goal)

    def _unlimited(self, controls: Floats, motion: Motion) -> Floats:
        goal = controls.copy()
        if motion.influence is not None:
            shares = self.shares(motion.influence)
            goal[shares > 0] = motion.shared(controls[shares > 0], shares[shares > 0])
        elif motion.individual and self.moves:
            goal[self.selected] = motion.about(controls[self.selected], self._own_origins)
        else:
            goal[self.selected] = motion.whole(controls[self.selected])
        return goal

    def reached(self, influence: Influence | None) -> Flags:
        """Which points the transform moves, (m,)."""
        return self.selected if influence is None else self.shares(influence) > 0

    def shares(self, influence: Influence) -> Floats:
        """Share of the transform of each point, (m,)."""
        if not self.moves:
            return np.zeros(len(self.selected))
        along = influence.connected and self.edges is not None
        shares = influence.shares(self._along if along else self._straight)
        return shares if self.free is None else np.asarray(np.where(self.free, shares, 0.0), np.float64)

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


def point_weights(selected: Flags, of_selected: float, of_others: float, given: Floats) -> Floats:
    """Response weights of points, selected or not, of the shape of those that the user gave, (m,) or (m, 3)."""
    chosen = np.where(selected, of_selected, of_others)
    return np.asarray(chosen.reshape(-1, *(1 for _ in given.shape[1:])) * given, np.float64)


def stored(frame: Floats, world: Floats, original: Singles, kept: Flags | None = None) -> Singles:
    """Local coordinates, (m, 3), in single precision, of points in world space.

    Points that are where `original`, (m, 3), the local ones at the start, put them keep those bit by bit: the way to
    the world and back may lose digits of coordinates that are far smaller than others. So do the single coordinates
    `kept`, (m, 3), where they differ by rounding alone.
    """
    local = as_single(frame, world)
    resting = (world == transform_points(frame, original)).all(axis=1)
    local[resting] = original[resting]
    if kept is not None:
        restored = kept & _is_rounding(frame, world, original)
        local[restored] = original[restored]
    return local


def _is_rounding(frame: Floats, world: Floats, original: Singles) -> Flags:
    """Which local coordinates, (m, 3), of points in world space differ from the original by rounding alone."""
    inverse = np.linalg.inv(frame).astype(np.float64)
    sizes = (np.abs(world) + np.abs(frame[:3, 3])) @ np.abs(inverse[:3, :3]).T
    return np.asarray(np.abs(transform_points(inverse, world) - original) <= ROUNDING * sizes)


def as_single(frame: Floats, world: Floats) -> Singles:
    """Local coordinates, (m, 3), in single precision, of points in world space."""
    local: Singles = transform_points(np.linalg.inv(frame).astype(np.float64), world).astype(np.float32)
    return local
