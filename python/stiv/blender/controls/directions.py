# SPDX-License-Identifier: GPL-3.0-or-later
"""Directions in which controls may move: of locks, pins and chosen axes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stiv.blender.scene.arrays import Flags, Floats

PARALLEL = 1e-6  # sine of the largest angle between normals that count as one


@dataclass(frozen=True, eq=False)
class FreeDirections:
    """Orthonormal directions in world space, with flags of those that are free.

    World axes stay exact: displacements along locked ones are then 0 to the last bit.

    Attributes:
        axes: (3, 3), a direction in each column.
        free: (3,) flags.
    """

    axes: Floats
    free: Flags

    @classmethod
    def of_normals(cls, normals: Floats) -> FreeDirections:
        """The directions perpendicular to all normals, (k, 3) of any length above 0.

        Blender's own numbers may be float32; the core asks for axes that are orthonormal in double precision.
        """
        normals = np.asarray(normals, np.float64)
        units = normals / np.linalg.norm(normals, axis=1)[:, None]
        along_world = np.abs(units) == 1
        if along_world.any(axis=1).all():
            return cls(np.eye(3), ~along_world.any(axis=0))
        _, sizes, directions = np.linalg.svd(units)
        return cls(directions.T, np.arange(3) >= int((sizes > PARALLEL).sum()))

    @classmethod
    def line(cls, direction: Floats) -> FreeDirections:
        """One direction, (3,), of any length above 0."""
        return cls.of_normals(direction[None]).opposite

    @property
    def opposite(self) -> FreeDirections:
        """Free where this is locked, and locked where it is free."""
        return FreeDirections(self.axes, ~self.free)

    @property
    def key(self) -> tuple[bytes, bytes]:
        """Equal for equal directions."""
        return self.axes.tobytes(), self.free.tobytes()

    def within(self, other: FreeDirections | None) -> FreeDirections:
        """The directions that are free in both; None restricts nothing."""
        if other is None or (other.free.all()):
            return self
        normals = np.concatenate([self.axes.T[~self.free], other.axes.T[~other.free]])
        return FreeDirections.of_normals(normals)

    def along(self, displacement: Floats) -> Floats:
        """Component of world displacements, (..., 3), along the free directions."""
        basis = self.axes[:, self.free]
        allowed: Floats = displacement @ basis @ basis.T
        return allowed


ALL_FREE = FreeDirections(np.eye(3), np.ones(3, np.bool_))
NONE_FREE = FreeDirections(np.eye(3), np.zeros(3, np.bool_))
