# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of objects in a scene of their own, where Blender evaluates them as in Object Mode or as rendered.

They exist only within a `with`: no undo step, file or handler outside of it ever sees them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import bpy

from stiv.blender.scene.evaluations import RENDER
from stiv.blender.scene.references import ObjectReference

NAME = "STIV Evaluation"
COPIED_TYPES = ("CURVE", "SURFACE", "FONT", "META")  # the resolution of which is kept in their data
SCENE_SETTINGS = ("frame_current", "frame_subframe", "gravity", "use_gravity")
TIME_SETTINGS = ("frame_map_old", "frame_map_new", "use_simplify", "simplify_subdivision")

_open = 0


def is_evaluating() -> bool:
    """Does a scene of copies exist right now? What handlers are told of then is no change of the user's."""
    return _open > 0


class Twins:
    """Copies of objects; `link` are those that are shown, all others only serve them."""

    def __init__(self, context: bpy.types.Context, evaluation: str) -> None:
        """Use `open_twins`."""
        self._evaluation = evaluation
        self._made: list[bpy.types.ID] = []
        self._twins: dict[int, bpy.types.Object] = {}
        self._users: dict[int, bpy.types.Object] = {}
        self._collections: dict[str, bpy.types.Collection] = {}
        self.scene = bpy.data.scenes.new(NAME)
        self._made.append(self.scene)
        self._adopt(context.scene)

    def fill(self, objects: Sequence[bpy.types.Object], shown: Callable[[bpy.types.Object], bool]) -> None:
        """Copy objects and have them evaluated."""
        for ob in objects:
            self._twins[ob.session_uid] = self._copy(ob)
        for ob in objects:
            self._redirect(self._twins[ob.session_uid])
            if shown(ob):
                self.scene.collection.objects.link(self._twins[ob.session_uid])
        self.scene.view_layers[0].update()

    @property
    def depsgraph(self) -> bpy.types.Depsgraph:
        """What evaluates them."""
        return self.scene.view_layers[0].depsgraph

    def owner(self, ob: bpy.types.Object) -> bpy.types.Object:
        """The object of the user's that a copy stands for; any other object itself."""
        return self._users.get(ob.session_uid, ob)

    def evaluated(self, reference: ObjectReference) -> bpy.types.Object:
        """What the copy of an object is evaluated to."""
        return self._twins[reference.session_uid].evaluated_get(self.depsgraph)

    def remove(self) -> None:
        """Leave nothing behind."""
        bpy.data.batch_remove(self._made)

    def _adopt(self, home: bpy.types.Scene) -> None:
        for name in SCENE_SETTINGS:
            setattr(self.scene, name, getattr(home, name))
        for name in TIME_SETTINGS:
            setattr(self.scene.render, name, getattr(home.render, name))
        if self._evaluation == RENDER:
            self.scene.render.simplify_subdivision = home.render.simplify_subdivision_render

    def _copy(self, ob: bpy.types.Object) -> bpy.types.Object:
        if ob.mode == "EDIT":
            ob.update_from_editmode()
        twin = ob.copy()
        self._made.append(twin)
        if ob.type == "META":  # metaballs merge by name, and one whose name got a number shows no surface
            twin.name = f"{NAME[0]}{ob.name}"
        if getattr(ob.data, "is_editmode", False) or ob.type in COPIED_TYPES:
            twin.data = ob.data.copy()
            self._made.append(twin.data)
        self._users[twin.session_uid] = ob
        if self._evaluation == RENDER:
            _as_rendered(twin)
        else:
            twin.hide_viewport = False
        return twin

    def _redirect(self, twin: bpy.types.Object) -> None:
        """Let a copy look at copies where there are some."""
        for owner in (*twin.modifiers, *twin.constraints):
            for item in owner.bl_rna.properties:
                if item.type == "POINTER" and not item.is_readonly:
                    self._exchange(owner, item.identifier, getattr(owner, item.identifier), setattr)
            if isinstance(owner, bpy.types.NodesModifier):
                for key, value in list(owner.items()):
                    self._exchange(owner, key, value, lambda where, name, new: where.__setitem__(name, new))
        if twin.parent is not None and twin.parent.session_uid in self._twins:
            twin.parent = self._twins[twin.parent.session_uid]
        if twin.instance_collection is not None:
            twin.instance_collection = self._collection(twin.instance_collection)

    def _exchange(self, owner: Any, name: str, value: Any, put: Callable[[Any, str, Any], None]) -> None:
        if isinstance(value, bpy.types.Object) and value.session_uid in self._twins:
            put(owner, name, self._twins[value.session_uid])
        elif isinstance(value, bpy.types.Collection) and self._collection(value) != value:
            put(owner, name, self._collection(value))

    def _collection(self, collection: bpy.types.Collection) -> bpy.types.Collection:
        """A collection of copies, where any of its objects has one."""
        if not any(ob.session_uid in self._twins for ob in collection.all_objects):
            return collection
        if collection.name_full not in self._collections:
            made = bpy.data.collections.new(NAME)
            self._made.append(made)
            self._collections[collection.name_full] = made
            made.instance_offset = collection.instance_offset
            for ob in collection.objects:
                made.objects.link(self._twins.get(ob.session_uid, ob))
            for child in collection.children:
                if self._evaluation != RENDER or not child.hide_render:
                    made.children.link(self._collection(child))
        return self._collections[collection.name_full]


@contextmanager
def open_twins(
    context: bpy.types.Context,
    evaluation: str,
    objects: Sequence[bpy.types.Object],
    shown: Callable[[bpy.types.Object], bool],
) -> Iterator[Twins]:
    """Copies of objects, evaluated as in Object Mode or as rendered; those for which `shown` says so are visible."""
    global _open
    _open += 1
    twins = Twins(context, evaluation)
    try:
        twins.fill(objects, shown)
        yield twins
    finally:
        twins.remove()
        _open -= 1


def _as_rendered(twin: bpy.types.Object) -> None:
    """Let the viewport show a copy as the render would."""
    twin.hide_viewport = twin.hide_render
    twin.show_instancer_for_viewport = twin.show_instancer_for_render
    for modifier in twin.modifiers:
        modifier.show_viewport = modifier.show_render
        if isinstance(modifier, bpy.types.SubsurfModifier | bpy.types.MultiresModifier):
            modifier.levels = modifier.render_levels
        elif isinstance(modifier, bpy.types.ScrewModifier):
            modifier.steps = modifier.render_steps
        elif isinstance(modifier, bpy.types.OceanModifier):
            modifier.viewport_resolution = modifier.resolution
    if isinstance(twin.data, bpy.types.MetaBall):
        twin.data.resolution = twin.data.render_resolution
    elif isinstance(twin.data, bpy.types.Curve):
        _refine_curve(twin.data)


def _refine_curve(curve: bpy.types.Curve) -> None:
    for axis in "uv":
        levels = getattr(curve, f"render_resolution_{axis}")
        if levels:
            setattr(curve, f"resolution_{axis}", levels)
            for spline in curve.splines:
                setattr(spline, f"resolution_{axis}", levels)
