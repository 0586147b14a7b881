# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersections that the live guard leaves alone, so that it guards everything else."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import bpy

from stiv.blender.scene.assembly import assemble_with_seams
from stiv.blender.scene.elements import Element, FacePair, FacePairs
from stiv.blender.scene.exclusions import without_excluded
from stiv.blender.scene.guarded_evaluations import read_guarded_scene
from stiv.blender.settings import EditSettings
from stiv.blender.verify.scene_check import find_pairs, tested_names
from stiv.task import Steps, Turns, run

MOST = 1000  # pairs of triangles; a copy of a large mesh in the place of its original has millions

ObjectPair = tuple[str, str]
"""Names of two objects in ascending order; the same name twice for an object that intersects itself."""


def find_intersections(context: bpy.types.Context, settings: EditSettings) -> FacePairs:
    """The intersecting pairs of the present scene that are not excluded, at most `MOST` of each two objects.

    Raises InputError.
    """
    return run(find_intersections_steps(context, settings))


def find_intersections_steps(context: bpy.types.Context, settings: EditSettings) -> Steps[FacePairs]:
    """Steps of `find_intersections`."""
    turns = Turns()
    scene, _ = read_guarded_scene(context, settings, tested_names(context, settings), strands=True)
    yield from turns.take()
    assembly = assemble_with_seams(scene.meshes, settings.ignored_pairs)
    yield from turns.take()
    pairs = find_pairs(assembly, settings.threads, 0 if len(settings.excluded) else MOST)
    return without_excluded(pairs, settings.excluded)


def fresh_objects(context: bpy.types.Context, settings: EditSettings, known: KnownIntersections) -> set[str]:
    """Names of the objects in intersections that are not known."""
    found = known.fresh(find_intersections(context, settings))
    return {name for both in found.by_objects() for name in both}


def object_pair(pair: FacePair) -> ObjectPair:
    """The objects of a pair of elements."""
    return objects_of(pair.first, pair.second)


def objects_of(first: Element, second: Element) -> ObjectPair:
    """The objects of two elements."""
    a, b = sorted((first.object, second.object))
    return a, b


@dataclass(frozen=True)
class KnownIntersections:
    """Pairs of elements that intersect in the accepted state.

    Two objects that intersect pass through each other until they are apart. Faces of one object that intersect stay as
    they are in each edit, and its other faces are guarded.
    """

    pairs: Sequence[FacePair] = ()

    @cached_property
    def objects(self) -> frozenset[ObjectPair]:
        """The pairs of objects."""
        return frozenset(FacePairs.of(self.pairs).by_objects())

    def left_out(self, settings: EditSettings, copies: Mapping[str, str] | None = None) -> EditSettings:
        """Settings of an edit that tests everything else.

        copies: names of objects that were copied, by the name of the copy; it passes through what the original did.
        """
        pairs = {pair for pair in self.objects if pair[0] != pair[1]}
        for copy, original in (copies or {}).items():
            pairs |= {(copy, other) for pair in pairs for other in pair if original in pair and other != original}
        return replace(settings, ignored_pairs=(*settings.ignored_pairs, *sorted(pairs)))

    def fresh(self, pairs: Iterable[FacePair]) -> FacePairs:
        """The pairs of objects that did not intersect before."""
        listed = FacePairs.of(pairs)
        return listed.chosen(listed.where(lambda *both: objects_of(*both) not in self.objects))
