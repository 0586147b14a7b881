# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading the evaluations of a scene by the package."""

from typing import Any

import bpy
import numpy as np
from building import edit_mode

from stiv.blender.scene.evaluated_scene import read_scene


def read_evaluation(evaluation: str) -> dict[str, np.ndarray]:
    """World positions of each mesh in an evaluation, by the name of its owner; leaves no data behind."""
    before = kept()
    meshes = read_scene(bpy.context, evaluations=(evaluation,)).meshes
    assert kept() == before
    assert len({mesh.owner for mesh in meshes}) == len(meshes)
    return {mesh.owner.name: mesh.world() for mesh in meshes}


def read_both(*edited: Any) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """The viewport's and the render's meshes, read while objects are in Edit Mode."""
    if edited:
        edit_mode(*edited)
    found = read_evaluation("viewport"), read_evaluation("render")
    if edited:
        bpy.ops.object.mode_set(mode="OBJECT")
    return found


def kept() -> dict[str, int]:
    """Numbers of data-blocks."""
    names = ("objects", "meshes", "scenes", "collections", "curves", "lattices", "shape_keys", "metaballs", "worlds")
    return {name: len(getattr(bpy.data, name)) for name in names}
