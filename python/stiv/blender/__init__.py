# SPDX-License-Identifier: GPL-3.0-or-later
"""The one place that reads a Blender scene and writes controls back."""

from stiv.blender.controls.loop_objects import add_refined, remove_refined
from stiv.blender.controls.loop_surfaces import refresh
from stiv.blender.controls.motion import Influence, Motion
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.edit.culled_edit import begin_nearby
from stiv.blender.edit.drawable import Contacts, contacts_of, triangles_of
from stiv.blender.edit.state_writer import WriteReport
from stiv.blender.guard.changes import Change, Changes, compare
from stiv.blender.guard.correction import Followed, follow
from stiv.blender.guard.reverting import revert
from stiv.blender.guard.scene_state import ObjectState, SceneState, read_state
from stiv.blender.repair.contraction import BlenderContraction, ContractionSettings, contract_scene
from stiv.blender.repair.expansion import BlenderExpansion, ExpansionSettings, expand_scene
from stiv.blender.repair.repair import BlenderRepair, RepairSettings, carry_out, repair_scene
from stiv.blender.repair.reshaping import ReshapeReport
from stiv.blender.scene.errors import SceneChangedError
from stiv.blender.scene.exclusions import Exclusions
from stiv.blender.scene.guarded_evaluations import Guard, choose_guard
from stiv.blender.scene.ray_casting import first_seen
from stiv.blender.scripts.enabling import enable
from stiv.blender.settings import EditSettings, Handles, LoopSurface, WeightGroup
from stiv.blender.verify.face_selection import faces_of, select_faces
from stiv.blender.verify.left_out import text_not_guarded
from stiv.blender.verify.nearest_pair import nearest_pair
from stiv.blender.verify.scene_check import SceneCheck, check_scene, exclusions_now, read_surface
from stiv.blender.verify.verification import FacePair

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
    "carry_out",
    "check_scene",
    "choose_guard",
    "compare",
    "contacts_of",
    "contract_scene",
    "enable",
    "exclusions_now",
    "expand_scene",
    "faces_of",
    "first_seen",
    "follow",
    "nearest_pair",
    "read_state",
    "read_surface",
    "refresh",
    "remove_refined",
    "repair_scene",
    "revert",
    "select_faces",
    "text_not_guarded",
    "triangles_of",
]
