# SPDX-License-Identifier: GPL-3.0-or-later
"""The one place that reads a Blender scene and writes controls back."""

from stiv.blender.changes import Change, Changes, compare
from stiv.blender.checking import SceneCheck, check_scene, read_surface
from stiv.blender.edit import BlenderEdit, WriteReport
from stiv.blender.errors import SceneChangedError
from stiv.blender.following import Followed, follow
from stiv.blender.loop_objects import add_refined, remove_refined
from stiv.blender.loop_surfaces import refresh
from stiv.blender.motion import Influence, Motion
from stiv.blender.scene_state import ObjectState, SceneState, read_state
from stiv.blender.settings import EditSettings, Handles, LoopSurface, WeightGroup
from stiv.blender.verification import FacePair

__all__ = [
    "BlenderEdit",
    "Change",
    "Changes",
    "EditSettings",
    "FacePair",
    "Followed",
    "Handles",
    "Influence",
    "LoopSurface",
    "Motion",
    "ObjectState",
    "SceneChangedError",
    "SceneCheck",
    "SceneState",
    "WeightGroup",
    "WriteReport",
    "add_refined",
    "check_scene",
    "compare",
    "follow",
    "read_state",
    "read_surface",
    "refresh",
    "remove_refined",
]
