# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves the selected objects together, by the least distance found, until they intersect no other object."""

from __future__ import annotations

from dataclasses import dataclass, replace

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.controls.editable import check_unkeyed
from stiv.blender.controls.participants import find_participants
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.scene.arrays import Floats, translation_matrix
from stiv.blender.scene.assembly import Assembly, assemble_against_others
from stiv.blender.scene.elements import FacePairs
from stiv.blender.scene.face_pairs import find_face_pairs
from stiv.blender.settings import EditSettings
from stiv.blender.verify.verification import read_shown
from stiv.deadlines import deadline_after, is_over, time_left
from stiv.separating import find_separation_steps
from stiv.task import Steps, run


@dataclass(frozen=True)
class SeparationReport:
    """The objects that were moved, those that they intersected, and the translation, (3,); 0 if nothing intersected.

    `out_of_time`: the time limit ended the search, and a shorter translation may exist.
    """

    moved: tuple[str, ...]
    others: tuple[str, ...]
    translation: Floats
    out_of_time: bool = False

    @property
    def distance(self) -> float:
        """Length of the translation."""
        return float(np.linalg.norm(self.translation))


def separate(context: bpy.types.Context, settings: EditSettings) -> SeparationReport:
    """Translate the selected objects by the least distance found that parts them from all other visible objects.

    Pairs of `ignored_pairs` may intersect. `time_budget` of the settings limits the search. Raises InputError, with
    nothing changed, if nothing can be moved, no direction parts them, or none was found in time.
    """
    return run(separate_steps(context, settings))


def separate_steps(context: bpy.types.Context, settings: EditSettings) -> Steps[SeparationReport]:
    """Steps of `separate`; the last one writes."""
    end = deadline_after(settings.time_budget)
    free = replace(settings, interference=False, object_response="rigid", responders="selected")
    participants = find_participants(context, free)
    for each in participants:
        check_unkeyed(each.reference.find())
    edit = yield from BlenderEdit.begin_with_steps(context, free, "move", participants)
    moving = edit.moving
    surfaces, is_moving = assemble_against_others(edit.assembly.meshes, moving, settings.ignored_pairs)
    pairs = find_face_pairs(surfaces, surfaces.positions, settings.threads)
    if not pairs:
        return SeparationReport(tuple(sorted(moving)), (), np.zeros(3))
    others = _others(pairs, moving)
    gap = settings.separation or 1e-4 * float(np.ptp(surfaces.positions[is_moving], axis=0).max())
    translation = yield from find_separation_steps(
        surfaces.surface, surfaces.positions, is_moving, gap, settings.threads, time_left(end)
    )
    if translation is None and is_over(end):
        raise InputError("time limit reached; raise it, or select fewer objects")
    if translation is None:
        raise InputError(f"{others[0]}: no direction parts it from the selection; repair it, or let it pass")
    out_of_time = is_over(end)
    _write(context, edit, surfaces, translation, settings)
    return SeparationReport(tuple(sorted(moving)), others, translation, out_of_time)


def _write(
    context: bpy.types.Context, edit: BlenderEdit, surfaces: Assembly, translation: Floats, settings: EditSettings
) -> None:
    """Translate, and test what Blender shows; if it intersects, restore and raise InputError."""
    edit.drag(translation_matrix(translation))
    edit.write()
    left = find_face_pairs(surfaces, read_shown(context, surfaces), settings.threads)
    if left:
        edit.restore()
        first, second = left[0].first.object, left[0].second.object
        name, other = (first, second) if first in edit.moving else (second, first)
        if not any(any(context.scene.objects[each].lock_location) for each in edit.moving):
            raise InputError(f"{name}: its shape changes as it moves; apply its modifiers")
        raise InputError(f"{name}: still intersects {other}; clear its locks")


def _others(pairs: FacePairs, moving: frozenset[str]) -> tuple[str, ...]:
    names = {name for both in pairs.by_objects() for name in both}
    return tuple(sorted(names - moving))
