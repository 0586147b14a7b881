# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens the evaluations of a scene for reading: the one shown now, and copies of the objects that differ in others."""

from collections.abc import Callable, Collection, Iterator
from contextlib import ExitStack, contextmanager

import bpy

from stiv.blender.scene.evaluation_copies import EvaluationCopies, open_copies
from stiv.blender.scene.evaluation_differences import Differences, find_differences
from stiv.blender.scene.evaluations import RENDER, SHOWN, VIEWPORT, is_visible
from stiv.blender.scene.references import ObjectReference


class OpenEvaluations:
    """Evaluations of a scene that can be read inside `open_evaluations`."""

    def __init__(
        self, context: bpy.types.Context, wanted: Collection[str] = (SHOWN,), differences: Differences | None = None
    ) -> None:
        """Use `open_evaluations`, except for the evaluation shown now alone."""
        self._context = context
        self._wanted = frozenset(wanted)
        self._differences = differences or Differences()
        self.copies: dict[str, EvaluationCopies] = {}

    @property
    def read_from(self) -> tuple[str, ...]:
        """The evaluations that have to be read."""
        return (SHOWN, *self.copies)

    def shown_in(self, read_from: str, number: int) -> frozenset[str]:
        """The wanted evaluations that show the object (session number) as this evaluation does."""
        different, found = self._differences, {read_from}
        if read_from == SHOWN and number not in different.viewport:
            found.add(VIEWPORT)
        if VIEWPORT in found and number in different.rendered and number not in different.render:
            found.add(RENDER)
        return frozenset(found & self._wanted)

    def hair_shown_in(self, number: int) -> frozenset[str]:
        """The wanted evaluations that show an object's particle hair, which is always read from the viewport."""
        found = {SHOWN, VIEWPORT} | ({RENDER} if number in self._differences.rendered else set())
        return frozenset(found & self._wanted)

    def instances(
        self, read_from: str, is_wanted: Callable[[bpy.types.Object], bool], types: Collection[str] = ("MESH",)
    ) -> Iterator[tuple[bpy.types.DepsgraphObjectInstance, bpy.types.Object, bpy.types.Object]]:
        """Each object of these types in an evaluation: the instance, its owner, and the object with its data."""
        copies = self.copies.get(read_from)
        for instance in self.depsgraph(read_from).object_instances:
            if instance.object.type not in types or not (instance.show_self or instance.is_instance):
                continue
            owner = instance.parent.original if instance.is_instance else instance.object.original
            source = instance.instance_object.original if instance.is_instance else owner
            if copies is not None:
                owner, source = copies.owner(owner), copies.owner(source)
            if is_wanted(owner):
                yield instance, owner, source

    def depsgraph(self, read_from: str) -> bpy.types.Depsgraph:
        """The dependency graph of an evaluation."""
        return self.copies[read_from].depsgraph if read_from in self.copies else self._context.evaluated_depsgraph_get()

    def evaluated(self, read_from: str, owner: ObjectReference) -> bpy.types.Object:
        """An evaluated object."""
        if read_from in self.copies:
            return self.copies[read_from].evaluated(owner)
        return owner.find().evaluated_get(self._context.evaluated_depsgraph_get())


@contextmanager
def open_evaluations(context: bpy.types.Context, wanted: Collection[str]) -> Iterator[OpenEvaluations]:
    """Open evaluations for reading: the one shown now, and copies of the objects that differ in others."""
    differences = find_differences(context, wanted)
    opened = OpenEvaluations(context, wanted, differences)
    with ExitStack() as stack:
        for evaluation, numbers in ((VIEWPORT, differences.viewport), (RENDER, differences.render)):
            objects = [ob for ob in bpy.data.objects if ob.session_uid in numbers] if evaluation in wanted else []
            if objects:
                shown = _rendered(differences) if evaluation == RENDER else (lambda ob: is_visible(context, ob))
                opened.copies[evaluation] = stack.enter_context(open_copies(context, evaluation, objects, shown))
        yield opened


def _rendered(differences: Differences) -> Callable[[bpy.types.Object], bool]:
    return lambda ob: ob.session_uid in differences.rendered
