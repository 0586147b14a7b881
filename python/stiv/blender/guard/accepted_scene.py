# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene that the live guard accepted last, from which it corrects the next result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import bpy

from stiv.blender.guard.known_intersections import KnownIntersections
from stiv.blender.guard.scene_state import SceneState, read_state
from stiv.blender.scene.elements import FacePair


@dataclass(frozen=True)
class AcceptedScene:
    """An accepted scene.

    Attributes:
        state: all visible objects.
        known: what intersects.
        objects: session numbers of all objects, hidden ones included.
        selected: session numbers of the selected objects; a new object is rather a copy of one of these.
    """

    state: SceneState
    known: KnownIntersections
    objects: frozenset[int]
    selected: frozenset[int]

    @staticmethod
    def read(context: bpy.types.Context, pairs: Sequence[FacePair] = ()) -> AcceptedScene:
        """The present scene, in which these pairs intersect."""
        objects = frozenset(ob.session_uid for ob in bpy.data.objects)
        return AcceptedScene(read_state(context), KnownIntersections(tuple(pairs)), objects, _selection(context))

    def with_selection(self, context: bpy.types.Context) -> AcceptedScene:
        """The same scene with the present selection."""
        return replace(self, selected=_selection(context))


def _selection(context: bpy.types.Context) -> frozenset[int]:
    return frozenset(ob.session_uid for ob in context.view_layer.objects if ob.select_get())
