# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene that the live guard accepted last, from which it corrects the next result."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import bpy
import numpy as np

from stiv.blender.guard.known_intersections import KnownIntersections
from stiv.blender.guard.scene_state import SceneState, read_state
from stiv.blender.scene.arrays import Flags, Indices, read_collection
from stiv.blender.scene.elements import FacePair, FacePairs


@dataclass(frozen=True)
class AcceptedScene:
    """An accepted scene.

    Attributes:
        state: all visible objects.
        known: what intersects.
        objects: session numbers of all objects, hidden ones included.
        selected: session numbers of the selected objects; a new object is rather a copy of one of these.
        selected_vertices: in Edit Mode, the numbers of each mesh's selected vertices, by session number.
    """

    state: SceneState
    known: KnownIntersections
    objects: frozenset[int]
    selected: frozenset[int]
    selected_vertices: Mapping[int, Indices] = field(default_factory=dict)

    @staticmethod
    def read(context: bpy.types.Context, pairs: Sequence[FacePair] = ()) -> AcceptedScene:
        """The present scene, in which these pairs intersect."""
        objects = frozenset(ob.session_uid for ob in bpy.data.objects)
        state, known = read_state(context), KnownIntersections(FacePairs.of(pairs))
        return AcceptedScene(state, known, objects, _selection(context), _selected_vertices(context))

    def with_selection(self, context: bpy.types.Context) -> AcceptedScene:
        """The same scene with the present selection."""
        return replace(self, selected=_selection(context), selected_vertices=_selected_vertices(context))


def _selection(context: bpy.types.Context) -> frozenset[int]:
    return frozenset(ob.session_uid for ob in context.view_layer.objects if ob.select_get())


def _selected_vertices(context: bpy.types.Context) -> dict[int, Indices]:
    meshes = [ob for ob in context.view_layer.objects if ob.type == "MESH" and ob.mode == "EDIT"]
    for ob in meshes:
        ob.update_from_editmode()
    return {ob.session_uid: _numbers(read_collection(ob.data.vertices, "select", 1, np.bool_)) for ob in meshes}


def _numbers(flags: Flags) -> Indices:
    return np.flatnonzero(flags).astype(np.int32)
