# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the controls of an object give way, as its settings say."""

from dataclasses import dataclass

import bpy
import numpy as np

from stiv.blender.controls.location_locks import FreeDirections
from stiv.blender.controls.points import PinnedDirections
from stiv.blender.scene.arrays import Flags, Floats, as_matrix
from stiv.blender.scene.vertex_groups import group_weights
from stiv.blender.settings import EditSettings


@dataclass(frozen=True)
class ControlWeights:
    """Response weights of the vertices of a mesh or the points of a lattice.

    Attributes:
        given: (m,) each along all axes, or (m, 3) along `directions`; 0 pins.
        directions: free those to which the vertex group does not apply, with weight 1; None: it applies to all.
        local_axes: (3,) the local coordinates to which it applies.
    """

    given: Floats
    directions: FreeDirections | None
    local_axes: Flags

    @property
    def movable(self) -> Flags:
        """Which controls move along some direction, (m,)."""
        return np.asarray((self.given > 0).reshape(len(self.given), -1).any(axis=1))

    @property
    def pinned(self) -> PinnedDirections | None:
        """The controls that move along the free directions only; None where the weights have no directions."""
        return pinned_directions(self.given, self.directions)

    @property
    def kept_coordinates(self) -> Flags | None:
        """Local coordinates, (m, 3), that pins along some axes keep; None where the weights have no directions."""
        pinned = self.pinned
        return None if pinned is None else np.asarray(pinned.points[:, None] & self.local_axes)


def control_weights(ob: bpy.types.Object, settings: EditSettings) -> ControlWeights:
    """The weights of an object's controls, 1 where no group is named.

    In Edit Mode as of the last `update_from_editmode`. Raises InputError for a group that there is not.
    """
    chosen = settings.weights.get(ob.name)
    if chosen is None:
        count = len(ob.data.vertices if ob.type == "MESH" else ob.data.points)
        return ControlWeights(np.ones(count), None, np.ones(3, np.bool_))
    weights = group_weights(ob, chosen.name, "weights")
    given = np.asarray(1.0 - weights if chosen.inverted else weights, np.float64)
    axes = np.array(chosen.axes, np.bool_)
    if axes.all():
        return ControlWeights(given, None, axes)
    directions = directions_beside(as_matrix(ob.matrix_world)[:3, :3], axes)
    return ControlWeights(np.where(directions.free, 1.0, given[:, None]), directions, axes)


def directions_beside(linear: Floats, axes: Flags) -> FreeDirections:
    """World directions: those free along which the local coordinates on `axes`, (3,), stay.

    linear: (3, 3), from local to world space. It may shear: the others are perpendicular to the free ones.
    """
    count = int((~axes).sum())
    directions, _ = np.linalg.qr(np.concatenate([linear[:, ~axes], linear[:, axes]], axis=1))
    directions[:, 2] *= np.sign(np.linalg.det(directions))
    return FreeDirections(directions.astype(np.float64), np.arange(3) < count)


def pinned_directions(given: Floats, directions: FreeDirections | None) -> PinnedDirections | None:
    """The controls with weight 0 along some of the directions, given (m, 3); None without directions."""
    return None if directions is None else PinnedDirections((given == 0).any(axis=1), directions)


def axes_of_weights(given: Floats, directions: FreeDirections | None) -> Floats | None:
    """The axes, (m, 3, 3), of weights (m, 3); None for weights (m,)."""
    return None if directions is None else np.broadcast_to(directions.axes, (len(given), 3, 3))
