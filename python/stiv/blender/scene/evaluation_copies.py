# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies of objects in a scene of their own, which Blender evaluates as in Object Mode or as rendered.

They exist only inside a `with` statement, so no undo step, file or handler outside it sees them.
Values that are not keyed yet count as they are, also in the render, so that an edit holds once they are keyed.
Rendered objects that the viewport hides follow their keyframes.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from typing import Any

import bpy

from stiv.blender.scene.animation_curves import is_animated
from stiv.blender.scene.dependencies import node_inputs
from stiv.blender.scene.evaluations import RENDER, SHOWN, is_active, is_edited
from stiv.blender.scene.followers import data_of, driving, find_driver_targets
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.temporary_data import note_copies
from stiv.blender.scene.unkeyed_values import UnkeyedValues, animated_below, forget_keyframes

NAME = "STIV Evaluation"
COPIED_TYPES = ("CURVE", "SURFACE", "FONT", "META")  # their data holds the resolution
SCENE_SETTINGS = ("frame_current", "frame_subframe", "gravity", "use_gravity")
TIME_SETTINGS = ("frame_map_old", "frame_map_new", "use_simplify", "simplify_subdivision")


class EvaluationCopies:
    """Copies of objects. Only some of them are shown; the others are referred to by these."""

    def __init__(self, home: bpy.types.Scene, evaluation: str, own_data: Collection[bpy.types.Object] = ()) -> None:
        """Make the scene; `fill` copies the objects. `own_data`: objects whose data is copied too."""
        note_copies()
        self._evaluation = evaluation
        self._own_data = frozenset(ob.session_uid for ob in own_data)
        self._made: list[bpy.types.ID] = []
        self._copies: dict[int, bpy.types.Object] = {}
        self._users: dict[int, bpy.types.Object] = {}
        self._collections: dict[str, bpy.types.Collection] = {}
        self.scene = bpy.data.scenes.new(NAME)
        self._made.append(self.scene)
        self._copy_settings(home)

    def fill(self, objects: Sequence[bpy.types.Object], shown: Callable[[bpy.types.Object], bool]) -> None:
        """Copy objects and the animated ones on which they depend, and evaluate them. `shown` selects the visible."""
        unkeyed = UnkeyedValues()
        copied = [*objects, *animated_below(objects)]
        for ob in copied:
            self._copies[ob.session_uid] = self._copy(ob)
        for ob in copied:
            self._replace_references(self._copies[ob.session_uid])
        for ob in filter(shown, objects):
            self.scene.collection.objects.link(self._copies[ob.session_uid])
        self.scene.view_layers[0].update()
        if unkeyed.restore():
            self.scene.view_layers[0].update()

    @property
    def depsgraph(self) -> bpy.types.Depsgraph:
        """Dependency graph of the copies."""
        return self.scene.view_layers[0].depsgraph

    def owner(self, ob: bpy.types.Object) -> bpy.types.Object:
        """The original of a copy; any other object itself."""
        return self._users.get(ob.session_uid, ob)

    def evaluated(self, reference: ObjectReference) -> bpy.types.Object:
        """The evaluated copy of an object."""
        return self.copy_of(reference).evaluated_get(self.depsgraph)

    def copy_of(self, reference: ObjectReference) -> bpy.types.Object:
        """The copy of an object."""
        return self._copies[reference.session_uid]

    def remove(self) -> None:
        """Remove all copies."""
        remove_copies([self])

    @property
    def made(self) -> list[bpy.types.ID]:
        """All that was made. Raises ReferenceError if undo or another file has removed it."""
        for each in self._made:
            each.session_uid  # noqa: B018 (raises)
        return self._made

    def _copy_settings(self, home: bpy.types.Scene) -> None:
        with _negative_frames():
            for name in SCENE_SETTINGS:
                setattr(self.scene, name, getattr(home, name))
        for name in TIME_SETTINGS:
            setattr(self.scene.render, name, getattr(home.render, name))
        if self._evaluation == RENDER:
            self.scene.render.simplify_subdivision = home.render.simplify_subdivision_render

    def _copy(self, ob: bpy.types.Object) -> bpy.types.Object:
        if is_edited(ob):
            ob.update_from_editmode()
        twin = ob.copy()
        self._made.append(twin)
        if ob.type == "META":  # metaballs merge by name, and a numbered name would show no surface
            twin.name = f"{NAME[0]}{ob.name}"
        if ob.session_uid in self._own_data or getattr(ob.data, "is_editmode", False) or _has_data_to_copy(ob):
            twin.data = ob.data.copy()
            self._made.append(twin.data)
        if self._evaluation != RENDER or ob.visible_get():  # values of hidden objects may be those of another frame
            for each in self._copied_blocks(twin):
                forget_keyframes(each)
        self._users[twin.session_uid] = ob
        if self._evaluation == RENDER:
            _as_rendered(twin)
        else:
            twin.hide_viewport = False
        if self._evaluation == SHOWN:
            for copied, modifier in zip(twin.modifiers, ob.modifiers, strict=True):
                copied.show_viewport = is_active(modifier, ob)
        return twin

    def _copied_blocks(self, twin: bpy.types.Object) -> list[bpy.types.ID]:
        """A copy of an object, with its data and shape keys if these are copies too."""
        return [twin, *(data_of(twin) if twin.data in self._made else ())]

    def _replace_references(self, twin: bpy.types.Object) -> None:
        """Replace the references of a copy by references to copies."""
        bones = [] if twin.pose is None else twin.pose.bones
        for owner in (*twin.modifiers, *twin.constraints, *(each for bone in bones for each in bone.constraints)):
            self._replace_pointers(owner)
            if isinstance(owner, bpy.types.NodesModifier):
                for where, name, value in node_inputs(owner):
                    self._replace_reference(where, name, value, operator.setitem if where is owner else setattr)
            if isinstance(owner, bpy.types.ArmatureConstraint):
                for target in owner.targets:
                    self._replace_reference(target, "target", target.target, setattr)
        for target in (each for owner in self._copied_blocks(twin) for each in find_driver_targets(owner)):
            self._replace_reference(target, "id", target.id, setattr)
        if twin.parent is not None and twin.parent.session_uid in self._copies:
            inverse = twin.matrix_parent_inverse.copy()
            twin.parent = self._copies[twin.parent.session_uid]
            twin.matrix_parent_inverse = inverse  # another parent has reset it
        if twin.instance_collection is not None:
            twin.instance_collection = self._collection(twin.instance_collection)

    def _replace_pointers(self, owner: bpy.types.Modifier | bpy.types.Constraint) -> None:
        inverse = owner.matrix_inverse.copy() if isinstance(owner, bpy.types.HookModifier) else None
        for item in owner.bl_rna.properties:
            if item.type == "POINTER" and not item.is_readonly:
                self._replace_reference(owner, item.identifier, getattr(owner, item.identifier), setattr)
        if isinstance(owner, bpy.types.HookModifier) and inverse is not None:
            owner.matrix_inverse = inverse  # another object has reset it

    def _replace_reference(self, owner: Any, name: str, value: Any, put: Callable[[Any, str, Any], None]) -> None:
        if isinstance(value, bpy.types.Object) and value.session_uid in self._copies:
            put(owner, name, self._copies[value.session_uid])
        elif isinstance(value, bpy.types.Collection) and self._collection(value) != value:
            put(owner, name, self._collection(value))

    def _collection(self, collection: bpy.types.Collection) -> bpy.types.Collection:
        """A collection of copies, if any of its objects has one."""
        if not any(ob.session_uid in self._copies for ob in collection.all_objects):
            return collection
        if collection.name_full not in self._collections:
            made = bpy.data.collections.new(NAME)
            self._made.append(made)
            self._collections[collection.name_full] = made
            made.instance_offset = collection.instance_offset
            for ob in collection.objects:
                made.objects.link(self._copies.get(ob.session_uid, ob))
            for child in collection.children:
                if self._evaluation != RENDER or not child.hide_render:
                    made.children.link(self._collection(child))
        return self._collections[collection.name_full]


def remove_copies(copies: Iterable[EvaluationCopies]) -> None:
    """Remove all copies at once: each removal takes Blender a look at every user in the file."""
    made: list[bpy.types.ID] = []
    for each in copies:
        with suppress(ReferenceError):
            made += each.made
    bpy.data.batch_remove(made)


def _has_data_to_copy(ob: bpy.types.Object) -> bool:
    """Would data that a copy shares be changed, or refer to originals? Rigs are posed by their objects."""
    if ob.type == "ARMATURE":
        return False
    return ob.type in COPIED_TYPES or any(is_animated(each) or any(driving(each)) for each in data_of(ob))


@contextmanager
def _negative_frames() -> Iterator[None]:
    """Let a scene be set to a frame below zero, which a preference forbids though a file can be there."""
    preferences = bpy.context.preferences
    before = preferences.edit.use_negative_frames, preferences.is_dirty
    preferences.edit.use_negative_frames = True
    try:
        yield
    finally:
        preferences.edit.use_negative_frames, preferences.is_dirty = before


@contextmanager
def open_copies(
    context: bpy.types.Context,
    evaluation: str,
    objects: Sequence[bpy.types.Object],
    shown: Callable[[bpy.types.Object], bool],
) -> Iterator[EvaluationCopies]:
    """Copy objects and evaluate them as in Object Mode or as rendered. `shown` selects the visible ones."""
    copies = EvaluationCopies(context.scene, evaluation)
    try:
        copies.fill(objects, shown)
        yield copies
    finally:
        copies.remove()


def _as_rendered(twin: bpy.types.Object) -> None:
    """Give a copy the settings of the render."""
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
