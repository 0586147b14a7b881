# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected and visible bones of a pose, in all versions of Blender."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import bpy


def is_selected(bone: bpy.types.PoseBone) -> bool:
    """Is a pose bone selected? Blender 5 stores this in the pose, earlier versions in the armature."""
    return bool(bone.select if hasattr(bone, "select") else bone.bone.select)


def is_hidden(bone: bpy.types.PoseBone) -> bool:
    """Is a pose bone hidden, by itself or by its collections?"""
    hidden = bone.hide if hasattr(bone, "hide") else bone.bone.hide
    collections: Sequence[bpy.types.BoneCollection] = bone.bone.collections
    return bool(hidden or (len(collections) and not any(each.is_visible_effectively for each in collections)))


def selected_bones(rig: bpy.types.Object) -> list[bpy.types.PoseBone]:
    """The visible selected bones of an armature."""
    return [bone for bone in rig.pose.bones if is_selected(bone) and not is_hidden(bone)]


def select_bones(rig: bpy.types.Object, names: Collection[str]) -> None:
    """Select these bones alone; the first becomes active."""
    for bone in rig.pose.bones:
        owner = bone if hasattr(bone, "select") else bone.bone
        owner.select = bone.name in names
    rig.data.bones.active = rig.data.bones.get(next(iter(names), ""))


def moved_bones(rig: bpy.types.Object, with_children: bool = False) -> list[bpy.types.PoseBone]:
    """The selected bones that a transform changes: without those that follow a selected parent, unless with them."""
    found = selected_bones(rig)
    chosen = {bone.name for bone in found}
    return [bone for bone in found if with_children or not any(each.name in chosen for each in bone.parent_recursive)]
