# SPDX-License-Identifier: GPL-3.0-or-later
"""Controls that are points: vertices of a cage, points of a lattice."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.directions import FreeDirections
from stiv.blender.controls.motion import Influence, Motion
from stiv.blender.controls.response import Response
from stiv.blender.controls.selection_distances import distances_along, island_centres, nearest_distances
from stiv.blender.scene.arrays import Flags, Floats, Indices, Singles, apply_linear, invert, transform_points

ROUNDING = 1e-11  # relative error of the conversions between local and world space during an edit


@dataclass(frozen=True)
class PinnedDirections:
    """Points, (m,) flags, that move only in the free directions."""

    points: Flags
    directions: FreeDirections

    def within(self, free: FreeDirections | None) -> "PinnedDirections":
        """The same points, pinned to the free directions too."""
        return replace(self, directions=self.directions.within(free))

    def limited(self, start: Floats, goal: Floats) -> Floats:
        """Restrict a goal, (m, 3), to the displacements that the pins allow."""
        allowed = goal.copy()
        displacement = goal[self.points] - start[self.points]
        allowed[self.points] = start[self.points] + self.directions.along(displacement)
        return allowed


@dataclass(frozen=True)
class PointGoal:
    """The selected points, (m,), follow the transform, and those near them as the influence decides.

    `start` are world positions, (m, 3); `edges`, (e, 2), connect the points, None if nothing does; `frame` is the
    object's world matrix in Object Mode, None in Edit Mode, where each island has its own origin; `free`, (m,), flags
    the points that can move, None for all; `pinned` restricts points to some directions, None for none.
    """

    selected: Flags
    start: Floats
    edges: Indices | None = None
    frame: Floats | None = None
    free: Flags | None = None
    pinned: PinnedDirections | None = None

    @property
    def moves(self) -> bool:
        """Is any point selected?"""
        return bool(self.selected.any())

    def goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of the points, (m, 3)."""
        goal = self._unrestricted(controls, motion)
        if motion.free is not None:
            goal = controls + motion.free.along(goal - controls)
        return goal if self.pinned is None else self.pinned.within(motion.free).limited(controls, goal)

    def _unrestricted(self, controls: Floats, motion: Motion) -> Floats:
        goal = controls.copy()
        if motion.influence is not None:
            shares = self.shares(motion.influence)
            goal[shares > 0] = motion.shared(controls[shares > 0], shares[shares > 0])
        elif self.frame is not None:
            goal[self.selected] = self._object_goal(controls[self.selected], self.frame, motion)
        elif motion.individual and self.moves:
            goal[self.selected] = motion.about(controls[self.selected], self._island_centres)
        else:
            goal[self.selected] = motion.whole(controls[self.selected])
        return goal

    def _object_goal(self, points: Floats, frame: Floats, motion: Motion) -> Floats:
        """Goal of the points, (k, 3), of a whole object. It turns onto a target, and follows its origin onto a face."""
        start, length = frame[:3, 3], float(np.linalg.norm(frame[:3, 2]))
        rows, moved = np.concatenate([points, start[None]]), replace(motion, place=None)
        if motion.align is not None and length > 0:
            rows = motion.align.turned(rows, motion.align.turn(frame[:3, 2] / length))
        rows = moved.about(rows, rows[-1]) if motion.individual else moved.whole(rows)
        placed = motion.placed(start[None], rows[-1:])[0]
        return np.asarray(rows[:-1] + (placed - rows[-1]), np.float64)

    def affected(self, influence: Influence | None) -> Flags:
        """Flags of the points that the transform moves, (m,)."""
        return self.selected if influence is None else self.shares(influence) > 0

    def limits(self, motion: Motion) -> tuple[object, ...]:
        """Proportional editing and an axis lock decide which points respond, and in which directions."""
        if motion.influence is None and motion.free is None:
            return ()
        return motion.influence, None if motion.free is None else motion.free.key

    def limited(self, control_set: ControlSet, motion: Motion, weight: float) -> ControlSet:
        """Points that the motion moves respond with this weight, along the axes of its lock."""
        moving = self.affected(motion.influence)
        response = Response(weight * control_set.max_weights, control_set.weight_axes)
        if motion.free is not None:
            response = response.along(motion.free)
        return Response(control_set.weights, control_set.weight_axes).replaced(moving, response).given_to(control_set)

    def turned(self, controls: Floats, goal: Floats) -> float:
        """0: points have no rotation."""
        return 0.0

    def shares(self, influence: Influence) -> Floats:
        """Fraction of the transform for each point, (m,)."""
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
    def _island_centres(self) -> Floats:
        return island_centres(self.start, self.selected, self.edges)


def point_weights(selected: Flags, of_selected: float, of_others: float, max_weights: Floats) -> Floats:
    """Response weights of selected and other points, in the shape of `max_weights`, (m,) or (m, 3)."""
    chosen = np.where(selected, of_selected, of_others)
    return np.asarray(chosen.reshape(-1, *(1 for _ in max_weights.shape[1:])) * max_weights, np.float64)


def to_stored(frame: Floats, world: Floats, original: Singles) -> Singles:
    """Convert world positions to stored local coordinates, (m, 3), in single precision.

    Coordinates that differ from those at the start, given by `original`, (m, 3), only by rounding keep them exactly:
    conversion loses digits of small coordinates, and locked ones may not change at all.
    """
    inverse = invert(frame)
    exact = transform_points(inverse, world)
    sizes = apply_linear(np.abs(inverse[:3, :3]), np.abs(world) + np.abs(frame[:3, 3]))
    resting = np.abs(exact - original) <= ROUNDING * sizes
    return np.asarray(np.where(resting, original, exact), np.float32)


def to_single(frame: Floats, world: Floats) -> Singles:
    """Local coordinates, (m, 3), in single precision, of world positions."""
    local: Singles = transform_points(invert(frame), world).astype(np.float32)
    return local
