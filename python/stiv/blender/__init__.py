# SPDX-License-Identifier: GPL-3.0-or-later
"""The one place that reads a Blender scene and writes controls back."""

from stiv.blender.changes import Change, Changes, compare
from stiv.blender.checking import SceneCheck, check_scene, read_surface
from stiv.blender.contracting import BlenderContraction, ContractionSettings, contract_scene
from stiv.blender.drawable import Contacts, contacts_of, triangles_of
from stiv.blender.edit import BlenderEdit
from stiv.blender.enabling import enable
from stiv.blender.errors import SceneChangedError
from stiv.blender.exclusions import Exclusions
from stiv.blender.expanding import BlenderExpansion, ExpansionSettings, expand_scene
from stiv.blender.following import Followed, follow
from stiv.blender.guarding import Guard, choose_guard
from stiv.blender.loop_objects import add_refined, remove_refined
from stiv.blender.loop_surfaces import refresh
from stiv.blender.motion import Influence, Motion
from stiv.blender.nearby import begin_nearby
from stiv.blender.repairing import BlenderRepair, RepairSettings, repair_scene
from stiv.blender.reshaping import ReshapeReport
from stiv.blender.reverting import revert
from stiv.blender.scene_state import ObjectState, SceneState, read_state
from stiv.blender.settings import EditSettings, Handles, LoopSurface, WeightGroup
from stiv.blender.showing import WriteReport
from stiv.blender.verification import FacePair

__all__ = [
    "BlenderContraction",
    "BlenderEdit",
    "BlenderExpansion",
    "BlenderRepair",
    "Change",
    "Changes",
    "Contacts",
    "ContractionSettings",
    "EditSettings",
    "Exclusions",
    "ExpansionSettings",
    "FacePair",
    "Followed",
    "Guard",
    "Handles",
    "Influence",
    "LoopSurface",
    "Motion",
    "ObjectState",
    "RepairSettings",
    "ReshapeReport",
    "SceneChangedError",
    "SceneCheck",
    "SceneState",
    "WeightGroup",
    "WriteReport",
    "add_refined",
    "begin_nearby",
    "check_scene",
    "choose_guard",
    "compare",
    "contacts_of",
    "contract_scene",
    "enable",
    "expand_scene",
    "follow",
    "read_state",
    "read_surface",
    "refresh",
    "remove_refined",
    "repair_scene",
    "revert",
    "triangles_of",
]
