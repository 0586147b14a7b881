# SPDX-License-Identifier: GPL-3.0-or-later
"""Corrects what is new in a scene: copies from the place of their original, extrusions, other new objects and parts."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace

import bpy
import numpy as np

from stiv.blender.controls.object_transform import read_transform, write_transform
from stiv.blender.guard.accepted_scene import AcceptedScene
from stiv.blender.guard.changes import Change, Changes, compare
from stiv.blender.guard.correction import ToolCorrection, correct_but_known_steps
from stiv.blender.guard.extrusion import extruded_from, is_among
from stiv.blender.guard.free_place import find_free_place
from stiv.blender.guard.known_intersections import KnownIntersections, find_intersections, fresh_objects
from stiv.blender.guard.new_parts import copied_from
from stiv.blender.guard.part_path import slide_part
from stiv.blender.guard.scene_state import ObjectState, SceneState, read_object, read_state
from stiv.blender.scene.arrays import Flags, Floats, Indices, Singles, translation_matrix
from stiv.blender.scene.elements import FacePair
from stiv.blender.scene.mesh_reading import read_edges
from stiv.blender.scene.references import ObjectReference
from stiv.blender.settings import EditSettings
from stiv.task import Steps

FIRST_FRACTIONS = (1 / 16, 1 / 64, 1 / 256)  # of an extrusion, from which its correction starts
ROUNDING = 1e-5  # of the coordinates of a mesh; a translation of its vertices differs by less


def find_originals(accepted: AcceptedScene, present: SceneState, new: Collection[int]) -> dict[int, int]:
    """The object of which each new one is a copy, by session number; all other objects are left out.

    Of several, it is one that was selected, and the nearest.
    """
    found = {}
    for number in new:
        place = present[number].world[:3, 3]
        candidates = {
            other: (other not in accepted.selected, float(np.linalg.norm(state.world[:3, 3] - place)))
            for other, state in accepted.state.items()
            if other in present and _is_copy(present[number], state)
        }
        if candidates:
            found[number] = min(candidates, key=lambda other: candidates[other])
    return found


def _is_copy(state: ObjectState, other: ObjectState) -> bool:
    """Do the objects have the same name up to its number, the same kind of data, and the same vertices or size?"""
    first, second = state.reference.find(), bpy.data.objects.get(other.reference.name)
    if second is None or first.type != second.type or _base_name(first.name) != _base_name(second.name):
        return False
    if state.kind != other.kind or not state.has_same_points(other):
        return False
    return state.points is not None or np.array_equal(first.bound_box, second.bound_box)


def _base_name(name: str) -> str:
    base, _, number = name.rpartition(".")
    return base if base and number.isdigit() else name


def find_in_place(accepted: AcceptedScene, present: SceneState, new: Collection[int]) -> tuple[str, str] | None:
    """Names of a new object and of the accepted one in whose place it is: a copy, or a part that was separated."""
    for number in new:
        state = present[number]
        for original in accepted.state.values():
            same_place = np.array_equal(state.world, original.world)
            if same_place and (_is_copy(state, original) or _is_part(state, original)):
                return state.reference.name, original.reference.name
    return None


def _is_part(state: ObjectState, original: ObjectState) -> bool:
    """Are all vertices those of another object?"""
    if state.points is None or original.points is None or len(state.points) >= len(original.points):
        return False
    return bool(len(state.points)) and bool(is_among(state.points, original.points).all())


def correct_copies(
    context: bpy.types.Context,
    settings: EditSettings,
    accepted: AcceptedScene,
    originals: Mapping[int, int],
    end: float,
) -> Steps[ToolCorrection]:
    """Steps that move copies from the places of their originals toward their own. They pass through all originals.

    end: the deadline. Raises InputError and SceneChangedError, with nothing changed.
    """
    present = read_state(context)
    base = dict(present)
    for copy, original in originals.items():
        start = accepted.state[original]
        base[copy] = replace(
            present[copy], location=start.location, rotation=start.rotation, scale=start.scale, world=start.world
        )
    names = {
        present[copy].reference.name: accepted.state[original].reference.name for copy, original in originals.items()
    }
    through = tuple((copy, original) for copy in names for original in names.values())
    settings = replace(settings, ignored_pairs=(*settings.ignored_pairs, *through))
    changes = compare(base, present)
    return (yield from correct_but_known_steps(context, settings, accepted.known, base, changes, end, names))


def correct_extrusion(
    context: bpy.types.Context,
    settings: EditSettings,
    accepted: AcceptedScene,
    reference: ObjectReference,
    end: float,
) -> Steps[ToolCorrection | None]:
    """Steps that pull an extrusion out again up to where it is blocked; None if the new vertices were not extruded.

    end: the deadline. Raises InputError and SceneChangedError, with nothing changed.
    """
    before, after = accepted.state[reference.session_uid], read_object(reference.find())
    if before.points is None or after.points is None or reference.find().type != "MESH":
        return None
    extruded = extruded_from(before.points, after.points, read_edges(reference.find().data))
    if extruded is None:
        return None
    origins, moved = extruded
    for fraction in FIRST_FRACTIONS:
        yield None
        points = origins + fraction * (after.points - origins)
        start = replace(after, points=np.where(moved[:, None], points, after.points).astype(np.float32))
        start.restore_points()
        context.view_layer.update()
        is_free = reference.name not in fresh_objects(context, settings, accepted.known)
        after.restore_points()
        context.view_layer.update()
        if is_free:
            base = {**read_state(context), reference.session_uid: start}
            change = Change(reference, moved=False, turned=False, scaled=False, points=moved)
            changes = Changes((change,))
            return (yield from correct_but_known_steps(context, settings, accepted.known, base, changes, end))
    return None


def find_copied(accepted: AcceptedScene, reference: ObjectReference, added: Flags) -> Indices | None:
    """The vertex, (k,), of which each added one is a copy; None without copies of the selected ones."""
    selected = accepted.selected_vertices.get(reference.session_uid, np.empty(0, np.int32))
    return copied_from(selected, added, read_edges(reference.find().data))


def correct_part(
    context: bpy.types.Context,
    settings: EditSettings,
    known: KnownIntersections,
    reference: ObjectReference,
    part: Flags,
    origins: Singles,
    end: float,
) -> Steps[bool | None]:
    """Steps that move components of a mesh from their vertices' origins, (k, 3), toward their place.

    Returns whether the place changed; None if the tool did not translate them from a free place. They move as a rigid
    body and pass through the rest of their object. end: the deadline. Raises InputError and SceneChangedError.
    """
    after = read_object(reference.find())
    assert after.points is not None
    ways = after.points[part].astype(np.float64) - origins
    if np.ptp(ways, axis=0).max() > ROUNDING * np.abs(after.points).max():  # turned or scaled
        return None
    way = after.world[:3, :3] @ ways.mean(axis=0)
    left_out = known.left_out(settings, touching=False)
    left_out = replace(left_out, ignored_pairs=(*left_out.ignored_pairs, (reference.name, reference.name)))
    made = yield from slide_part(context, left_out, {reference.name: part}, way, end)
    if made is None:
        return None
    if np.linalg.norm(made - way) <= ROUNDING * np.linalg.norm(way):
        return False
    _translate_part(context, after, part, made - way)
    return True


def touches_others(pairs: Iterable[FacePair], names: Collection[str]) -> bool:
    """Does any pair join one of the named objects and another object?"""
    return any((pair.first.object in names) != (pair.second.object in names) for pair in pairs)


def place_freely(
    context: bpy.types.Context, settings: EditSettings, known: KnownIntersections, names: Collection[str], end: float
) -> Steps[bool]:
    """Steps that put new objects, which stay together, at the nearest free place.

    end: the deadline. False, with nothing changed, without success.
    """
    translation = yield from find_free_place(context, known.left_out(settings, touching=False), names, end)
    if translation is None or not translation.any():
        return False
    roots = [ob for ob in map(bpy.data.objects.get, names) if ob and (not ob.parent or ob.parent.name not in names)]
    before = [read_object(ob) for ob in roots]
    if any(ob.library is not None for ob in roots):
        return False
    for ob in roots:
        write_transform(ob, read_transform(ob), translation_matrix(translation), np.ones(3))
    context.view_layer.update()
    if touches_others(known.fresh(find_intersections(context, settings)), names):
        for state in before:
            state.restore_placement()
        context.view_layer.update()
        return False
    return True


def place_part_freely(
    context: bpy.types.Context,
    settings: EditSettings,
    known: KnownIntersections,
    reference: ObjectReference,
    added: Flags,
    end: float,
) -> Steps[bool]:
    """Steps that put a new part of a mesh at the nearest free place; False, with nothing changed, without success.

    end: the deadline.
    """
    left_out = known.left_out(settings, touching=False)
    translation = yield from find_free_place(context, left_out, (), end, {reference.name: added})
    if translation is None or not translation.any():
        return False
    before = read_object(reference.find())
    _translate_part(context, before, added, translation)
    if reference.name not in fresh_objects(context, settings, known):
        return True
    before.restore_points()
    context.view_layer.update()
    return False


def _translate_part(context: bpy.types.Context, state: ObjectState, added: Flags, translation: Floats) -> None:
    """Write the vertices of a state, some of them translated in the world."""
    assert state.points is not None
    points = state.points.copy()
    points[added] += np.linalg.solve(state.world[:3, :3], translation)
    replace(state, points=points).restore_points()
    context.view_layer.update()
