# SPDX-License-Identifier: GPL-3.0-or-later
"""Corrects poses and values of shape keys that a tool changed: the changed channels and sliders respond."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import bpy
import numpy as np

import stiv
from stiv.blender.controls.bone_channels import BoneChannels, StoredChannels
from stiv.blender.controls.bone_set import check_rig
from stiv.blender.controls.control_set import Participant
from stiv.blender.controls.participants import find_clothes
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.guard.correction import ToolCorrection, correction_deadline, correction_settings, move_to_goal
from stiv.blender.guard.scene_state import ObjectState, PoseState, SceneState
from stiv.blender.morphing.key_sliders import find_sliders
from stiv.blender.morphing.morph import limits_toward
from stiv.blender.morphing.morph_edit import MorphEdit
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings
from stiv.deadlines import is_over
from stiv.task import Left, Steps

MORPHING_TIME = 0.25  # seconds of one call that moves sliders; it is repeated while there is time


def correct_poses_steps(
    context: bpy.types.Context,
    settings: EditSettings,
    accepted: SceneState,
    wanted: SceneState,
    posed: Sequence[ObjectReference],
    end: float | None = None,
) -> Steps[ToolCorrection]:
    """Edit from accepted poses and values of shape keys toward the wanted ones, and write the result.

    posed: the objects that differ. Between steps, the scene shows accepted ones. A result that needs no correction
    stays as it is exactly. Channels and values that drivers set are left to them. Raises InputError,
    StartIntersectsError and SceneChangedError; the tool's result then remains.

    end: the deadline; None for the time budget of the settings from now.
    """
    end = correction_deadline(settings) if end is None else end
    pairs = [(accepted[each.session_uid], wanted[each.session_uid]) for each in posed]
    try:
        _restore(context, [former for former, _ in pairs])
        bones = yield from _correct_bones(context, settings, pairs, end)
        yield None
        keys = yield from _correct_keys(context, settings, pairs, end)
    except Left:
        raise
    except BaseException:
        _restore(context, [state for _, state in pairs])
        raise
    found = [each for each in (bones, keys) if each is not None and each.corrected]
    blocking = {name for each in found for name in each.blocking}
    names = tuple(state.reference.name for _, state in pairs)
    message = next((each.message for each in found if each.message), "")
    notes = tuple(note for each in (bones, keys) if each is not None for note in each.notes)
    cut, stopped = next((each.cut for each in found if each.cut), ()), any(each.stopped for each in found)
    return ToolCorrection(bool(found), names, tuple(sorted(blocking)), message, (), cut, stopped, notes)


def _restore(context: bpy.types.Context, states: Sequence[ObjectState]) -> None:
    for state in states:
        state.pose.restore(state.reference.find())
    context.view_layer.update()


def _correct_bones(
    context: bpy.types.Context, settings: EditSettings, pairs: Sequence[tuple[ObjectState, ObjectState]], end: float
) -> Steps[ToolCorrection | None]:
    """Steps that pose all changed bones at once; None if none changed."""
    rigs = [(wanted, bones) for former, wanted in pairs if (bones := _changed_bones(former, wanted))]
    if not rigs:
        return None
    for wanted, _ in rigs:
        check_rig(wanted.reference.find())
    participants = [Participant(wanted.reference, "bones", True, tuple(b for b, _ in bones)) for wanted, bones in rigs]
    clothes = find_clothes(context, settings)
    limited = correction_settings(settings)
    edit = yield from BlenderEdit.begin_with_steps(context, limited, "rotate", [*participants, *clothes])
    start, goal = edit.controls, edit.controls.copy()
    scalars = np.concatenate([channels[bone.free] for _, bones in rigs for bone, channels in bones])
    goal[: len(scalars), 0] = scalars
    outcome = yield from move_to_goal(edit, goal, end)
    if outcome.reached and np.array_equal(edit.controls[len(scalars) :], start[len(scalars) :]):
        solved = [replace(wanted, pose=PoseState.read(wanted.reference.find())) for wanted, _ in rigs]
        _restore(context, [replace(wanted, pose=replace(wanted.pose, keys=())) for wanted, _ in rigs])
        if edit.is_shown():
            return ToolCorrection(False, (), notes=edit.untested_notes)
        _restore(context, solved)
    if context.scene.tool_settings.use_keyframe_insert_auto:
        edit.insert_keyframes(context)
    names = tuple(wanted.reference.name for wanted, _ in rigs)
    return ToolCorrection(
        True, names, outcome.blocking, outcome.message, (), outcome.cut, outcome.stopped, edit.untested_notes
    )


def _changed_bones(former: ObjectState, wanted: ObjectState) -> list[tuple[BoneChannels, Floats]]:
    """The bones that a tool changed, and the channels, (10,), to which it did."""
    before = {bone[0]: bone for bone in former.pose.bones}
    rig, found = wanted.reference.find(), []
    for name, location, rotation_name, rotation, scale in wanted.pose.bones:
        if before.get(name) in (None, (name, location, rotation_name, rotation, scale)):
            continue
        bone = rig.pose.bones[name]
        channels = BoneChannels.read(rig, bone, True)
        goal = channels.stored_goal(StoredChannels(location, rotation, scale))
        driven = {path.removeprefix(f"{bone.path_from_id()}.") for path in _driven_paths(rig)}
        channels = channels.free_to(goal, driven)
        if len(channels.free):
            found.append((channels, goal))
    return found


def _driven_paths(owner: bpy.types.ID) -> set[str]:
    animation = owner.animation_data
    return set() if animation is None else {driver.data_path for driver in animation.drivers}


def _correct_keys(
    context: bpy.types.Context, settings: EditSettings, pairs: Sequence[tuple[ObjectState, ObjectState]], end: float
) -> Steps[ToolCorrection | None]:
    """Steps that move all changed values of shape keys at once; None if none changed."""
    values = _changed_values(pairs)
    if not values:
        return None
    sliders, goals, given = find_sliders(values, False)
    wanted, is_given = np.array(goals), np.array(given)
    limited = replace(settings, time_budget=MORPHING_TIME)
    limits = limits_toward(sliders, wanted, is_given)
    edit = MorphEdit.begin_with(context, limited, sliders, limits)
    result, message = yield from _move_sliders(edit, wanted, end)
    notes = (edit.torn_seam_note,) if edit.torn_seam_note else ()
    if np.array_equal(edit.values, wanted) and not edit.has_moved_clothes:
        return ToolCorrection(False, (), notes=notes)
    edit.insert_keyframes(context)
    is_stopped = not message and is_over(end)
    return ToolCorrection(True, tuple(values), tuple(result.blocking), message, stopped=is_stopped, notes=notes)


def _move_sliders(edit: MorphEdit, wanted: Floats, end: float) -> Steps[tuple[stiv.EditResult, str]]:
    """Steps that move sliders toward their values, (k,), until a deadline.

    They return the last result with contacts, and why the values of the last call are not shown, or "". Between steps,
    the scene shows values that passed the test.
    """
    while True:
        result, is_done = edit.advance(wanted, MORPHING_TIME)
        message = edit.show()
        yield None
        if is_done or message or is_over(end):
            break
    while not message and not is_over(end):
        settled = edit.settle()
        result, message = (settled if settled.blocking else result), edit.show()
        yield None
        if settled.status != "budget":
            break
    return result, message


def _changed_values(pairs: Sequence[tuple[ObjectState, ObjectState]]) -> dict[str, dict[str, float]]:
    """The values that a tool changed, by object and key; of shared shape keys, by one of the objects."""
    values: dict[str, dict[str, float]] = {}
    seen: set[int] = set()
    for former, wanted in pairs:
        keys = getattr(wanted.reference.find().data, "shape_keys", None)
        if keys is None or keys.session_uid in seen:
            continue
        seen.add(keys.session_uid)
        before, driven = dict(former.pose.keys), _driven_paths(keys)
        changed = {name: value for name, value in wanted.pose.keys if before.get(name, value) != value}
        free = [name for name in changed if keys.key_blocks[name].path_from_id("value") not in driven]
        values |= {wanted.reference.name: {name: changed[name] for name in free}} if free else {}
    return values
