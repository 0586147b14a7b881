# SPDX-License-Identifier: GPL-3.0-or-later
"""Chooses the evaluations that a resolved animation keeps free of intersections, and the meshes in its file."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace

import bpy

from stiv import InputError
from stiv.blender.animation.controls import move_alike
from stiv.blender.animation.tracks import Track
from stiv.blender.scene.evaluations import RENDER
from stiv.blender.scene.guarded_evaluations import Guard, checked_evaluations

WAY_OUT = "or use --guard viewport"


def choose_animation_guard(context: bpy.types.Context, choice: str) -> Guard:
    """Choose the guard; "auto" is what `stiv check` tests: both, unless the render has too many triangles."""
    if choice != "auto":
        return Guard(choice)
    if RENDER in checked_evaluations(context):
        return Guard("both")
    return Guard("viewport", "the render is not guarded: too many triangles; use --guard both")


def written_tracks(tracks: Sequence[Track]) -> list[Track]:
    """The tracks that the file will show.

    Rigid objects keep their modifiers, and with them the meshes of all evaluations. Deforming objects are written
    without modifiers, so their first mesh is shown in all evaluations. Raises InputError for objects that move
    differently in two evaluations, and for deforming objects that only the render shows.
    """
    groups: dict[int, list[Track]] = defaultdict(list)
    for track in tracks:
        if not track.mesh.is_instance:
            groups[track.mesh.owner.session_uid].append(track)
    written: dict[int, Track | None] = {id(track): track for track in tracks}
    for group in groups.values():
        _check_alike(group)
        if any(track.kind == "shape" for track in group):
            _check_shown(group[0])
            written.update(_in_all_evaluations(group))
    return [kept for track in tracks if (kept := written[id(track)]) is not None]


def _in_all_evaluations(group: Sequence[Track]) -> dict[int, Track | None]:
    """Tracks by `id`: the first mesh is shown in all evaluations; None for the meshes that it replaces."""
    first = group[0].mesh.shown_in
    everywhere = first.union(*(track.mesh.shown_in for track in group))
    return {
        id(track): replace(track, mesh=replace(track.mesh, shown_in=everywhere))
        if track.mesh.shown_in == first
        else None
        for track in group
    }


def _check_alike(group: Sequence[Track]) -> None:
    kinds: dict[frozenset[str], set[str]] = defaultdict(set)
    for track in group:
        kinds[track.mesh.shown_in].add(track.kind)
    others = (track for track in group if track.mesh.shown_in != group[0].mesh.shown_in)
    if len(kinds) > 1 and (
        any(each != kinds[group[0].mesh.shown_in] for each in kinds.values())
        or any(track.kind == group[0].kind == "rigid" and not move_alike(group[0], track) for track in others)
    ):
        raise InputError(
            f"{group[0].mesh.owner.name}: moves differently when rendered; show the same modifiers, {WAY_OUT}"
        )


def _check_shown(track: Track) -> None:
    ob = track.mesh.owner.find()
    if not ob.visible_get():
        raise InputError(f"{ob.name}: deforms and is only rendered; show it in the viewport, {WAY_OUT}")
