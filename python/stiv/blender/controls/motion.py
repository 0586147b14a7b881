# SPDX-License-Identifier: GPL-3.0-or-later
"""Motions of the selection: a transform, its pivot, and the influence of proportional editing."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv import InputError
from stiv.blender.controls.directions import FreeDirections
from stiv.blender.controls.rotations import fixed_point, is_rotation, rotation_between, rotation_vector
from stiv.blender.scene.arrays import Floats, apply_linear, transform_points

ROUNDING = 1e-9  # relative error of the matrix of a motion
AXIS_DECIMALS = 9  # of an axis that is computed from a matrix, so that rounding does not change it
FALLOFFS = ("SMOOTH", "SPHERE", "ROOT", "INVERSE_SQUARE", "SHARP", "LINEAR", "CONSTANT", "RANDOM")


@dataclass(frozen=True)
class Influence:
    """Proportional editing: points near the selection follow it.

    Attributes:
        size: radius around selected points, world units, above 0.
        falloff: one of FALLOFFS, as Blender names them.
        connected: measure distances along the edges of the cage.
    """

    size: float
    falloff: str = "SMOOTH"
    connected: bool = False

    def __post_init__(self) -> None:
        """Refuse invalid values."""
        if not (np.isfinite(self.size) and self.size > 0):
            raise InputError(f"size of the influence: {self.size!r} must be a finite number above 0")
        if self.falloff not in FALLOFFS:
            raise InputError(f"falloff: {self.falloff!r} is none of {', '.join(FALLOFFS)}")

    def shares(self, distances: Floats) -> Floats:
        """Fraction of the transform, 0 to 1, at distances from the selection, (m,)."""
        t = np.clip(1 - distances / self.size, 0, 1)
        curves = {
            "SMOOTH": t * t * (3 - 2 * t), "SPHERE": np.sqrt(t * (2 - t)), "ROOT": np.sqrt(t),
            "INVERSE_SQUARE": t * (2 - t), "SHARP": t * t, "LINEAR": t, "CONSTANT": np.sign(t),
            "RANDOM": t * np.random.default_rng(0).random(len(t)),  # constant during a drag
        }  # fmt: skip
        shares: Floats = np.where(distances == 0, 1, curves[self.falloff])
        return shares


@dataclass(frozen=True)
class Alignment:
    """Turns the Z axis of each object onto a direction, as Align Rotation to Target does.

    Attributes:
        normal: (3,) unit direction.
        source: (3,) point of the selection that stays in place while it turns.
    """

    normal: Floats
    source: Floats

    def turn(self, up: Floats) -> Floats:
        """The rotation, (3, 3), of an object with this Z axis, (3,)."""
        return rotation_between(up, self.normal)

    def turned(self, points: Floats, turn: Floats) -> Floats:
        """Points, (k, 3), rotated about the source."""
        return np.asarray(self.source + apply_linear(turn, points - self.source), np.float64)


@dataclass(frozen=True)
class Motion:
    """An absolute motion of the selection since the start of an edit.

    Attributes:
        matrix: (4, 4) world transform.
        pivot: (3,) fixed point of the linear part; the rest of the matrix is a translation.
        individual: each object, island of vertices or lattice uses its own origin as pivot.
        influence: proportional editing; None for none.
        rotation: (3,) rotation vector of the matrix if it exceeds half a turn; otherwise None.
        free: directions in which an axis lock lets points and objects move; None without one.
        align: rotation of whole objects before the matrix moves them; None without.
        place: where points end, (k, 3), from where they start and where the matrix takes them, (k, 3) each; for
            instance on faces. Objects follow their origins. None: where the matrix takes them.
    """

    matrix: Floats
    pivot: Floats
    individual: bool = False
    influence: Influence | None = None
    rotation: Floats | None = None
    free: FreeDirections | None = None
    place: Callable[[Floats, Floats], Floats] | None = None
    align: Alignment | None = None

    @staticmethod
    def of(max_weights: "Motion | ArrayLike") -> "Motion":
        """A motion, or a (4, 4) matrix alone. Raises InputError if it is not finite."""
        motion = (
            max_weights if isinstance(max_weights, Motion) else Motion(np.asarray(max_weights, np.float64), np.zeros(3))
        )
        matrix = np.asarray(motion.matrix, np.float64)
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all() or not np.isfinite(motion.pivot).all():
            raise InputError("transform: must be a matrix of 4 x 4 finite numbers")
        pivot = motion.pivot if isinstance(max_weights, Motion) else fixed_point(matrix)
        return replace(motion, matrix=matrix, pivot=pivot)

    @property
    def axis(self) -> Floats | None:
        """Unit axis, (3,), of a rotation about the pivot, in either sense; None for any other motion."""
        size = np.abs(self.pivot).max() + np.abs(self.matrix[:3, 3]).max()
        if not is_rotation(self.linear) or np.abs(self.shift).max() > ROUNDING * size:
            return None
        vector = rotation_vector(self.linear) if self.rotation is None else self.rotation
        length = float(np.linalg.norm(vector))
        if length == 0:
            return None
        unit = np.round(vector / length, AXIS_DECIMALS)
        unit *= np.sign(unit[np.flatnonzero(unit)[0]]) / np.linalg.norm(unit)
        axis: Floats = unit + 0.0  # no -0
        return axis

    @property
    def is_uniform(self) -> bool:
        """Does the linear part scale alike in all directions?"""
        factor = self.linear[0, 0]
        return bool(np.abs(self.linear - factor * np.eye(3)).max() <= ROUNDING * abs(factor))

    @property
    def linear(self) -> Floats:
        """Linear part, (3, 3)."""
        return self.matrix[:3, :3]

    @property
    def shift(self) -> Floats:
        """Translation of the pivot, (3,)."""
        moved: Floats = transform_points(self.matrix, self.pivot[None])[0] - self.pivot
        return moved

    def whole(self, points: Floats) -> Floats:
        """Transform points, (k, 3)."""
        return self.placed(points, transform_points(self.matrix, points))

    def placed(self, points: Floats, moved: Floats) -> Floats:
        """Where points end that the matrix takes from `points` to `moved`, (k, 3) each."""
        return moved if self.place is None else self.place(points, moved)

    def about(self, points: Floats, origins: Floats) -> Floats:
        """Transform points, (k, 3), each about its own origin, (k, 3) or (3,)."""
        moved: Floats = origins + apply_linear(self.linear, points - origins) + self.shift
        return self.placed(points, moved)

    def shared(self, points: Floats, shares: NDArray[Any]) -> Floats:
        """Transform points, (k, 3), each by a fraction, (k,): rotations by that fraction of the angle."""
        arms = points - self.pivot
        if is_rotation(self.linear):
            vector = rotation_vector(self.linear) if self.rotation is None else self.rotation
            moved = _turned(arms, vector, shares)
        else:
            moved = arms + shares[:, None] * (apply_linear(self.linear, arms) - arms)
        return self.placed(points, self.pivot + moved + shares[:, None] * self.shift)


def _turned(arms: Floats, vector: Floats, shares: NDArray[Any]) -> Floats:
    """Rotate vectors, each by a fraction of a rotation (Rodrigues)."""
    angle = float(np.linalg.norm(vector))
    if angle == 0:
        return arms
    axis, turns = vector / angle, (shares * angle)[:, None]
    along = (arms @ axis)[:, None] * axis
    turned: Floats = along + np.cos(turns) * (arms - along) + np.sin(turns) * np.cross(axis, arms)
    return turned
