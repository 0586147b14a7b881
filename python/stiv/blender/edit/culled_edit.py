# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits in large scenes, beside obstacles of which only the part near the motion is read at each step."""

from __future__ import annotations

from collections.abc import Sequence

import bpy

from stiv.blender.controls.control_set import Participant
from stiv.blender.controls.participants import find_participants
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.scene.obstacle_choice import find_obstacles
from stiv.blender.scene.static_reading import forget_static_meshes
from stiv.blender.settings import EditSettings, check_kind
from stiv.task import Steps, run


def begin_culled_edit(context: bpy.types.Context, settings: EditSettings, kind: str) -> BlenderEdit:
    """Begin an edit as `BlenderEdit.begin` does; in large scenes beside the objects that certainly stay as they are.

    Raises the same errors.
    """
    return run(begin_culled_steps(context, settings, kind))


def begin_culled_steps(context: bpy.types.Context, settings: EditSettings, kind: str) -> Steps[BlenderEdit]:
    """Steps of `begin_culled_edit`; the first reads the scene."""
    check_kind(kind)
    participants = find_participants(context, settings)
    obstacles = find_obstacles(context, names_of(participants), settings)
    if not obstacles:
        forget_static_meshes()
    steps = BlenderEdit.begin_with_steps(context, settings, kind, participants, obstacles=obstacles)
    return (yield from steps)


def names_of(participants: Sequence[Participant]) -> set[str]:
    """Names of the participants."""
    return {each.reference.name for each in participants}
