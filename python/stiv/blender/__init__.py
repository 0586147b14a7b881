# SPDX-License-Identifier: GPL-3.0-or-later
"""The one place that reads a Blender scene and writes controls back."""

from stiv.blender.checking import SceneCheck, check_scene, read_surface
from stiv.blender.edit import BlenderEdit, WriteReport
from stiv.blender.errors import SceneChangedError
from stiv.blender.motion import Influence, Motion
from stiv.blender.settings import EditSettings, Handles, WeightGroup
from stiv.blender.verification import FacePair

__all__ = [
    "BlenderEdit",
    "EditSettings",
    "FacePair",
    "Handles",
    "Influence",
    "Motion",
    "SceneChangedError",
    "SceneCheck",
    "WeightGroup",
    "WriteReport",
    "check_scene",
    "read_surface",
]
