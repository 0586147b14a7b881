# SPDX-License-Identifier: GPL-3.0-or-later
"""How far the controls of an object give way, as its settings say."""

import bpy
import numpy as np

from stiv.blender.arrays import Floats
from stiv.blender.settings import EditSettings
from stiv.blender.vertex_groups import group_weights


def control_weights(ob: bpy.types.Object, settings: EditSettings) -> Floats:
    """A weight for each vertex of a mesh or point of a lattice, (m,): 0 pins, 1 where no group is named.

    In Edit Mode as of the last `update_from_editmode`. Raises InputError for a group that there is not.
    """
    chosen = settings.weights.get(ob.name)
    if chosen is None:
        return np.ones(len(ob.data.vertices if ob.type == "MESH" else ob.data.points))
    weights = group_weights(ob, chosen.name, "weights")
    return np.asarray(1.0 - weights if chosen.inverted else weights, np.float64)
