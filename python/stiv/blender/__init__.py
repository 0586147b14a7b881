# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits, tests and repairs scenes in Blender; the only part of STIV that imports `bpy`."""

from stiv.blender.controls.bone_set import has_movable_bones, poses_surface
from stiv.blender.controls.directions import FreeDirections
from stiv.blender.controls.loop_surfaces import add_refined, refresh, remove_refined
from stiv.blender.controls.motion import Alignment, Influence, Motion
from stiv.blender.controls.participants import moves_surface
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.edit.contact_region import ContactRegion, contact_region
from stiv.blender.edit.drawable import triangles_of
from stiv.blender.edit.ghost import Ghost, GhostSource
from stiv.blender.edit.kept_session import free_kept_data
from stiv.blender.edit.results import is_cut_by_topology
from stiv.blender.edit.sessions import ObjectsIntersectError
from stiv.blender.edit.state_writer import WriteReport
from stiv.blender.excluded_faces import Exclusions
from stiv.blender.guard.accepted_scene import AcceptedScene
from stiv.blender.guard.changes import Change, Changes, compare
from stiv.blender.guard.correction import ToolCorrection, correct_after_tool
from stiv.blender.guard.guarding import GuardedResult, guard_result, guard_result_steps
from stiv.blender.guard.known_intersections import KnownIntersections, find_intersections, object_pair
from stiv.blender.guard.scene_state import ObjectState, SceneState, read_state, revert
from stiv.blender.layout.dropping import (
    Drop,
    DropSettings,
    SettleIntoContact,
    SettleSettings,
    drop,
    settle_into_contact,
)
from stiv.blender.layout.layout_task import LayoutReport, LayoutTask
from stiv.blender.layout.packing import FitInto, FitSettings, fit_into
from stiv.blender.layout.placing import Place, PlaceSettings, place
from stiv.blender.layout.pushing_apart import PushApart, push_apart
from stiv.blender.morphing.key_sliders import movable_keys
from stiv.blender.morphing.morph import MorphReport, MorphTask, morph
from stiv.blender.morphing.morph_edit import MorphEdit
from stiv.blender.repair.contraction import BlenderContraction, ContractionSettings, contract_scene
from stiv.blender.repair.edit_mode_shapes import EditModeShapes
from stiv.blender.repair.expansion import BlenderExpansion, ExpansionSettings, expand_scene
from stiv.blender.repair.repair import BlenderRepair, RepairSettings, repair_scene, run_to_end
from stiv.blender.repair.reshaping import ReshapeReport
from stiv.blender.repair.separation import SeparationReport, separate, separate_steps
from stiv.blender.scene.elements import Element, FacePair, FacePairs, count_faces
from stiv.blender.scene.exclusions import intersection_text, without_excluded
from stiv.blender.scene.guarded_evaluations import Guard, choose_guard
from stiv.blender.scene.lattice_reading import read_selected_lattice_points
from stiv.blender.scene.message_fitting import fit_message
from stiv.blender.scene.modifier_stack import UnsupportedStackError
from stiv.blender.scene.pose_bones import moved_bones, select_bones
from stiv.blender.scene.references import SceneChangedError
from stiv.blender.scene.snap_targets import SnapMesh, SnapTarget, read_snap_targets
from stiv.blender.scene.stack_twin import kept_twins
from stiv.blender.scene.temporary_data import copies_made, on_copies
from stiv.blender.scripts.enabling import enable
from stiv.blender.settings import EditSettings, Handles, LoopSurface, WeightGroup
from stiv.blender.verify.face_selection import faces_of, select_faces
from stiv.blender.verify.scene_check import SceneCheck, check_scene, find_exclusions, nearest_pair, read_surface
from stiv.blender.verify.untested import find_without_surface, unguarded_text
from stiv.task import Steps, Task
from stiv.task import run as run_steps

follow = correct_after_tool  #: the name of `correct_after_tool` in version 0.1.0

__all__ = [
    "AcceptedScene",
    "Alignment",
    "BlenderContraction",
    "BlenderEdit",
    "BlenderExpansion",
    "BlenderRepair",
    "Change",
    "Changes",
    "ContactRegion",
    "ContractionSettings",
    "Drop",
    "DropSettings",
    "EditModeShapes",
    "EditSettings",
    "Element",
    "Exclusions",
    "ExpansionSettings",
    "FacePair",
    "FacePairs",
    "FitInto",
    "FitSettings",
    "FreeDirections",
    "Ghost",
    "GhostSource",
    "Guard",
    "GuardedResult",
    "Handles",
    "Influence",
    "KnownIntersections",
    "LayoutReport",
    "LayoutTask",
    "LoopSurface",
    "MorphEdit",
    "MorphReport",
    "MorphTask",
    "Motion",
    "ObjectState",
    "ObjectsIntersectError",
    "Place",
    "PlaceSettings",
    "PushApart",
    "RepairSettings",
    "ReshapeReport",
    "SceneChangedError",
    "SceneCheck",
    "SceneState",
    "SeparationReport",
    "SettleIntoContact",
    "SettleSettings",
    "SnapMesh",
    "SnapTarget",
    "Steps",
    "Task",
    "ToolCorrection",
    "UnsupportedStackError",
    "WeightGroup",
    "WriteReport",
    "add_refined",
    "check_scene",
    "choose_guard",
    "compare",
    "contact_region",
    "contract_scene",
    "copies_made",
    "correct_after_tool",
    "count_faces",
    "drop",
    "enable",
    "expand_scene",
    "faces_of",
    "find_exclusions",
    "find_intersections",
    "find_without_surface",
    "fit_into",
    "fit_message",
    "follow",
    "free_kept_data",
    "guard_result",
    "guard_result_steps",
    "has_movable_bones",
    "intersection_text",
    "is_cut_by_topology",
    "kept_twins",
    "morph",
    "movable_keys",
    "moved_bones",
    "moves_surface",
    "nearest_pair",
    "object_pair",
    "on_copies",
    "place",
    "poses_surface",
    "push_apart",
    "read_selected_lattice_points",
    "read_snap_targets",
    "read_state",
    "read_surface",
    "refresh",
    "remove_refined",
    "repair_scene",
    "revert",
    "run_steps",
    "run_to_end",
    "select_bones",
    "select_faces",
    "separate",
    "separate_steps",
    "settle_into_contact",
    "triangles_of",
    "unguarded_text",
    "without_excluded",
]
