# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersecting faces as arrays of world positions, for the overlay."""

from collections.abc import Sequence

import bpy
import numpy as np

from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.elements import FacePair
from stiv.blender.scene.evaluated_scene import read_scene
from stiv.blender.verify.face_selection import faces_of


def triangles_of(context: bpy.types.Context, pairs: Sequence[FacePair]) -> Floats:
    """Triangles, (t, 3, 3), of all faces in the pairs, as Blender shows them now."""
    faces = faces_of(pairs)
    found = [np.empty((0, 3, 3))]
    for mesh in read_scene(context, lambda name: len(faces.get(name, ())) > 0).meshes:
        wanted = np.isin(mesh.faces, faces[mesh.owner.name])
        found.append(mesh.world()[mesh.triangles[wanted]])
    return np.concatenate(found)
