# SPDX-License-Identifier: GPL-3.0-or-later
"""Response weights of an object's controls, from its settings."""

from dataclasses import dataclass, replace

import bpy
import numpy as np

from stiv.blender.controls.control_set import Participant
from stiv.blender.controls.directions import FreeDirections
from stiv.blender.controls.points import PinnedDirections, point_weights
from stiv.blender.scene.arrays import Flags, Floats, as_matrix
from stiv.blender.scene.shape_keys import read_mix
from stiv.blender.scene.vertex_groups import group_weights
from stiv.blender.settings import EditSettings


@dataclass(frozen=True)
class ControlWeights:
    """Response weights of the vertices of a mesh or the points of a lattice.

    Attributes:
        max_weights: (m,) for all axes, or (m, 3) along `directions`; 0 pins.
        directions: directions to which the vertex group does not apply are free, with weight 1; None if it applies to
            all.
    """

    max_weights: Floats
    directions: FreeDirections | None

    @property
    def movable(self) -> Flags:
        """Flags of the controls that can move in some direction, (m,)."""
        return np.asarray((self.max_weights > 0).reshape(len(self.max_weights), -1).any(axis=1))

    @property
    def pinned(self) -> PinnedDirections | None:
        """The controls that move only in the free directions; None if the weights have no directions."""
        return pinned_directions(self.max_weights, self.directions)


def control_weights(ob: bpy.types.Object, settings: EditSettings) -> ControlWeights:
    """Read the weights of an object's controls; 1 without a vertex group, 0 where a shape key has no effect.

    In Edit Mode as of the last `update_from_editmode`. Raises InputError if there is no such group.
    """
    found = _weights_of_group(ob, settings)
    if ob.type != "MESH" or ob.data.shape_keys is None:
        return found
    hidden = read_mix(ob).shares == 0
    return replace(
        found, max_weights=np.where(hidden.reshape(-1, *(1,) * (found.max_weights.ndim - 1)), 0.0, found.max_weights)
    )


def _weights_of_group(ob: bpy.types.Object, settings: EditSettings) -> ControlWeights:
    chosen = settings.weights.get(ob.name)
    if chosen is None:
        count = len(ob.data.vertices if ob.type == "MESH" else ob.data.points)
        return ControlWeights(np.ones(count), None)
    weights = group_weights(ob, chosen.name, "weights")
    max_weights = np.asarray(1.0 - weights if chosen.inverted else weights, np.float64)
    axes = np.array(chosen.axes, np.bool_)
    if axes.all():
        return ControlWeights(max_weights, None)
    directions = free_directions_of(as_matrix(ob.matrix_world)[:3, :3], axes)
    return ControlWeights(np.where(directions.free, 1.0, max_weights[:, None]), directions)


def response_weights(participant: Participant, moving: Flags, max_weights: Floats, settings: EditSettings) -> Floats:
    """Response weights of moving and other controls, by who yields; unselected participants always do."""
    others = settings.response_weight(False) if participant.selected else 1.0
    return point_weights(moving, settings.response_weight(True), others, max_weights)


def free_directions_of(linear: Floats, axes: Flags) -> FreeDirections:
    """World directions that leave the local coordinates on `axes`, (3,), unchanged.

    linear: (3, 3), from local to world space. It may shear: the other directions are perpendicular to the free ones.
    """
    count = int((~axes).sum())
    directions, _ = np.linalg.qr(np.concatenate([linear[:, ~axes], linear[:, axes]], axis=1))
    directions[:, 2] *= np.sign(np.linalg.det(directions))
    return FreeDirections(directions.astype(np.float64), np.arange(3) < count)


def pinned_directions(max_weights: Floats, directions: FreeDirections | None) -> PinnedDirections | None:
    """The controls with weight 0, of (m, 3), in some of the directions; None without directions."""
    return None if directions is None else PinnedDirections((max_weights == 0).any(axis=1), directions)


def axes_of_weights(max_weights: Floats, directions: FreeDirections | None) -> Floats | None:
    """The axes, (m, 3, 3), of weights (m, 3); None for weights (m,)."""
    return None if directions is None else np.broadcast_to(directions.axes, (len(max_weights), 3, 3))
