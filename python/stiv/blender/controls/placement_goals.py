# SPDX-License-Identifier: GPL-3.0-or-later
"""How the placement of a rigid group follows a motion, and how it may respond: by rows of its controls, (2, 3)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

import stiv
from stiv import InputError
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.directions import ALL_FREE, NONE_FREE, FreeDirections
from stiv.blender.controls.motion import Motion
from stiv.blender.controls.placed_stack import PlacedStack
from stiv.blender.controls.placement_motion import PlacementMotion
from stiv.blender.controls.placement_writer import PlacementWriter
from stiv.blender.controls.response import Response
from stiv.blender.controls.rotations import nearest_equivalent, nearest_rotation, rotation_vector
from stiv.blender.scene.arrays import Floats

SLANT = 1e-6  # cosine below which a scaled axis is perpendicular to one of the object's own
UNIFORM = FreeDirections(  # of three equal factors
    np.array([[1, 1, 1], [1, -1, 0], [1, 1, -2]]).T / np.sqrt([3, 2, 6]), np.array([True, False, False])
)


@dataclass(frozen=True)
class PlacementGoal:
    """Centre and rotation vector of a group that a motion moves.

    Attributes:
        selected: whether the motion moves the group.
        turns: whether the group may rotate.
        origin: (3,) that of the first root with a surface, the pivot for individual origins.
        free: directions that location locks leave free, None for all.
        up: (3,) unit Z axis of that root, which alignment turns; None if the group cannot be rotated.
        tied: names of two objects because of which the group can only move as one; None without.
    """

    selected: bool
    turns: bool
    origin: Floats
    free: FreeDirections | None = None
    up: Floats | None = None
    tied: tuple[str, str] | None = None

    @property
    def moves(self) -> bool:
        """Is the group selected?"""
        return self.selected

    def goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of centre and second row, (2, 3)."""
        if not self.selected:
            return controls
        # Where the origin is placed, the centre follows.
        points, moved = np.stack([controls[0], self.origin]), replace(motion, place=None)
        if motion.align is not None and self.up is not None:
            return self._aligned(points, last, motion, motion.align.turn(self.up))
        centre, origin = moved.about(points, self.origin) if motion.individual else moved.whole(points)
        centre = centre + motion.placed(points[1:], origin[None])[0] - origin
        for free in (self.free, motion.free):
            centre = centre if free is None else controls[0] + free.along(centre - controls[0])
        return np.array([centre, self.second_goal(controls, last, motion)])

    def _aligned(self, points: Floats, last: Floats, motion: Motion, turn: Floats) -> Floats:
        """Goal of a group that turns before it moves; a lock holds for its origin. `points`: centre and origin."""
        assert motion.align is not None
        centre, origin = points
        goal = motion.whole(motion.align.turned(points, turn))[1]
        if motion.free is not None:
            goal = origin + motion.free.along(goal - origin)
        vector = nearest_equivalent(rotation_vector(nearest_rotation(motion.linear) @ turn), last[1])
        return np.array([goal + motion.linear @ turn @ (centre - origin), vector])

    def second_goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of the rotation vector, (3,)."""
        if not self.turns:
            return np.zeros(3)
        return nearest_equivalent(rotation_vector(nearest_rotation(motion.linear)), last[1])

    def limits(self, motion: Motion) -> tuple[object, ...]:
        """The axis lock."""
        return () if motion.free is None or not self.selected else motion.free.key

    def limited(self, control_set: ControlSet, motion: Motion, weight: float) -> ControlSet:
        """The centre responds along the axes of a lock, and the group does not turn then."""
        if not self.limits(motion):
            return control_set
        assert motion.free is not None
        place = motion.free.within(self.free)
        return respond(control_set, place, NONE_FREE, weight)

    def own_origin(self, motion: Motion) -> Floats | None:
        """The origin, (3,), if each object uses its own as pivot. Raises InputError if the group moves as one."""
        if not motion.individual:
            return None
        if self.tied is not None:
            raise InputError(f'{self.tied[1]}: only moves together with "{self.tied[0]}"; choose another pivot')
        return self.origin

    def turned(self, controls: Floats, goal: Floats) -> float:
        """Angle in radians by which a selected group rotates though its goal does not."""
        return float(np.linalg.norm(controls[1])) if self.selected and not goal[1].any() else 0.0


class PivotDeformation:
    """Deformation of a group about the pivot of a drag; kept while the pivot stays.

    `make` returns the deformation for a motion, and the stack that Blender evaluates for it, if any.
    """

    def __init__(self, make: Callable[[PlacementMotion], tuple[stiv.Deformation, PlacedStack | None]]) -> None:
        self._make = make
        self._made: tuple[tuple[object, ...], tuple[stiv.Deformation, PlacedStack | None]] | None = None

    def given_to(self, control_set: ControlSet, pivot: Floats | None, origin: Floats | None) -> ControlSet:
        """The control set with the deformation about a pivot, (3,), and None for that of its motion.

        origin: that of the first object, if each object uses its own. The same objects for the same pivot and origin.
        """
        assert isinstance(control_set.writer, PlacementWriter)
        motion = control_set.writer.motion
        motion = replace(motion, pivot=motion.pivot if pivot is None else pivot, origin=origin)
        key = motion.pivot.tobytes(), None if origin is None else origin.tobytes()
        if self._made is None or self._made[0] != key:
            self._made = key, self._make(motion)
        deformation, placed = self._made[1]
        return replace(
            control_set, deformation=deformation, placed=placed, writer=replace(control_set.writer, motion=motion)
        )


@dataclass(frozen=True)
class RotationGoal(PlacementGoal):
    """Rotates about the pivot of the motion, and responds by nothing else.

    Attributes:
        about: makes the deformation for a pivot.
        free_axis: whether contact may change the axis if the user did not choose it.
        pivoting: whether the deformation is that about the pivot.
        axis: (3,) that the goal keeps; None for any.
    """

    about: PivotDeformation = field(kw_only=True)
    free_axis: bool = False
    pivoting: bool = False
    axis: Floats | None = None

    def goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of centre and rotation vector, (2, 3); the centre is that at the start, since the pivot is fixed."""
        if not self.pivoting:
            return super().goal(controls, last, motion)
        turn = self.second_goal(controls, last, motion)
        return np.array([controls[0], turn if self.axis is None else self.axis * (turn @ self.axis)])

    def limits(self, motion: Motion) -> tuple[object, ...]:
        """Axis and pivot of the rotation, and whether the axis was chosen; empty if the motion places the origin."""
        if not self.selected or not self.turns or motion.axis is None or motion.place is not None:
            return ()
        return motion.axis.tobytes(), self._pivot(motion).tobytes(), motion.free is not None, motion.individual

    def limited(self, control_set: ControlSet, motion: Motion, weight: float) -> ControlSet:
        """The angle responds; the axis too if objects may turn on contact and none was chosen."""
        axis, pivot = motion.axis, self._pivot(motion)
        if not self.limits(motion) or axis is None:
            return control_set
        turning = ALL_FREE if self.free_axis and motion.free is None else FreeDirections.line(axis)
        pivoting = self.about.given_to(control_set, pivot, self.own_origin(motion))
        rule = replace(self, axis=None if turning is ALL_FREE else axis, pivoting=True)
        return replace(respond(pivoting, NONE_FREE, turning, weight), rule=rule)

    def _pivot(self, motion: Motion) -> Floats:
        return self.origin if motion.individual else motion.pivot


@dataclass(frozen=True)
class ScaleGoal(PlacementGoal):
    """Centre and scale factors along `axes`, (3, 3).

    about: makes the deformation for a pivot. askew: names of two objects with other axes; these allow three equal
    factors only.
    """

    axes: Floats = field(kw_only=True)
    about: PivotDeformation = field(kw_only=True)
    askew: tuple[str, str] | None = None

    def second_goal(self, controls: Floats, last: Floats, motion: Motion) -> Floats:
        """Goal of the factors, (3,). Raises InputError for factors of 0, and for other factors than the axes allow."""
        if self.askew is not None and not motion.is_uniform:
            first, other = self.askew
            raise InputError(f'{other}: moves with "{first}" but has another rotation; scale it alone')
        factors: Floats = np.einsum("ki,kl,li->i", self.axes, motion.linear, self.axes)
        if not factors.all():
            raise InputError("a scale of 0 would flatten objects; choose another factor")
        return np.full(3, factors.mean()) if motion.is_uniform else factors

    def limits(self, motion: Motion) -> tuple[object, ...]:
        """The chosen axes, or whether the scale is uniform."""
        if not self.selected:
            return ()
        return motion.is_uniform, motion.individual, *(() if motion.free is None else motion.free.key)

    def limited(self, control_set: ControlSet, motion: Motion, weight: float) -> ControlSet:
        """A uniform scale stays uniform; with chosen axes, each of their factors responds."""
        if not self.selected:
            return control_set
        place = ALL_FREE if motion.free is None else motion.free
        if motion.individual:
            control_set = self.about.given_to(control_set, None, self.own_origin(motion))
        return respond(control_set, place.within(self.free), self._factors(motion), weight)

    def turned(self, controls: Floats, goal: Floats) -> float:
        """0: scaled groups do not turn."""
        return 0.0

    def _factors(self, motion: Motion) -> FreeDirections:
        if self.askew is not None or (motion.free is None and motion.is_uniform):
            return UNIFORM
        if motion.free is None:
            return ALL_FREE
        chosen = np.abs(self.axes.T @ motion.free.axes[:, motion.free.free]).max(axis=1, initial=0.0)
        return FreeDirections(np.eye(3), chosen > SLANT)


def respond(control_set: ControlSet, first: FreeDirections, second: FreeDirections, weight: float) -> ControlSet:
    """The control set of a placement whose rows respond in these directions with a weight."""
    weights = weight * np.array([first.free, second.free], np.float64)
    axes = np.array([first.axes, second.axes])
    return Response(weights, None if (axes == np.eye(3)).all() else axes).given_to(control_set)
