# SPDX-License-Identifier: GPL-3.0-or-later
"""Locked or pinned axes: the directions that are left to move in."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from stiv.blender.controls.object_transform import ObjectTransform
from stiv.blender.scene.arrays import Flags, Floats


@dataclass(frozen=True)
class FreeDirections:
    """Orthonormal directions in world space, and which of them locks or pins leave free.

    Attributes:
        axes: (3, 3), a direction a column.
        free: (3,) of each direction.
    """

    axes: Floats
    free: Flags

    def along(self, displacement: Floats) -> Floats:
        """The component along the free directions of world displacements, (..., 3)."""
        basis = self.axes[:, self.free]
        allowed: Floats = displacement @ basis @ basis.T
        return allowed


def free_directions(objects: Sequence[bpy.types.Object], starts: Sequence[ObjectTransform]) -> FreeDirections | None:
    """The directions in which objects can move together while each keeps its locked location channels.

    Channels count along the axes of the parent. None: no channel is locked.
    """
    rows = [
        np.linalg.inv(start.above[:3, :3])[list(ob.lock_location)] for ob, start in zip(objects, starts, strict=True)
    ]
    normals = np.concatenate(rows)
    if len(normals) == 0:
        return None
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    _, sizes, directions = np.linalg.svd(normals)
    locked = int((sizes > 1e-6).sum())
    return FreeDirections(directions.T.astype(np.float64), np.arange(3) >= locked)


def keep_locked(ob: bpy.types.Object, start: ObjectTransform) -> None:
    """Put the locked location channels back, bit by bit: the way through the world rounds them."""
    for axis in np.flatnonzero(ob.lock_location):
        ob.location[axis] = start.location[axis]
