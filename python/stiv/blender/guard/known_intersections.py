# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersections that the live guard leaves alone, so that it guards everything else."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import bpy
import numpy as np

from stiv.blender.scene.arrays import Indices
from stiv.blender.scene.assembly import Assembly, assemble_with_seams
from stiv.blender.scene.elements import FacePair, FacePairs, objects_of
from stiv.blender.scene.exclusions import without_excluded
from stiv.blender.scene.guarded_evaluations import read_guarded_scene
from stiv.blender.settings import EditSettings
from stiv.blender.verify.scene_check import find_triangle_pairs, meshes_of, name_pairs, tested_names
from stiv.outside_contacts import touching_from_outside
from stiv.task import Steps, Turns, run

MOST = 1000  # pairs of triangles; a copy of a large mesh in the place of its original has millions
MOST_TOUCHING = 20_000  # pairs of triangles of two objects that may touch; those with more count as cutting each other

ObjectPair = tuple[str, str]
"""Names of two objects in ascending order; the same name twice for an object that intersects itself."""


def find_intersections(context: bpy.types.Context, settings: EditSettings) -> FacePairs:
    """The intersecting pairs of the present scene that are not excluded, at most `MOST` of each two objects.

    They tell which objects only touch. Raises InputError.
    """
    return run(find_intersections_steps(context, settings))


def find_intersections_steps(
    context: bpy.types.Context, settings: EditSettings, moving: Collection[str] | None = None
) -> Steps[FacePairs]:
    """Steps of `find_intersections`. moving: names of objects; pairs of two others are left out."""
    turns = Turns()
    scene, _ = read_guarded_scene(context, settings, tested_names(context, settings), strands=True)
    yield from turns.take()
    assembly = assemble_with_seams(scene.meshes, settings.ignored_pairs, moving)
    yield from turns.take()
    triangles = find_triangle_pairs(assembly, settings.threads)
    yield from turns.take()
    pairs = name_pairs(assembly, triangles, settings.threads, 0 if len(settings.excluded) else MOST)
    yield from turns.take()
    loose = pairs.chosen(pairs.where(lambda *both: {each.kind for each in both} != {"face"}))
    touching = _touching_objects(assembly, triangles) - set(loose.by_objects())
    found = FacePairs(pairs.owners, pairs.owner, pairs.number, pairs.triangle_pairs, touching)
    return without_excluded(found, settings.excluded)


def _touching_objects(assembly: Assembly, triangles: Indices) -> frozenset[ObjectPair]:
    """The names of each two objects whose triangles in pairs, (k, 2), touch from outside, and do not cut."""
    names, numbers = np.unique([mesh.owner.name for mesh in assembly.meshes], return_inverse=True)
    owners = numbers.reshape(-1)[meshes_of(assembly, triangles)]
    order = np.argsort(owners, axis=1, kind="stable")  # of each pair, the first triangle belongs to the first name
    ordered = np.take_along_axis(triangles, order, axis=1)
    both, group, counts = np.unique(np.sort(owners, axis=1), axis=0, return_inverse=True, return_counts=True)
    may_touch = np.flatnonzero((both[:, 0] != both[:, 1]) & (counts <= MOST_TOUCHING))
    rows = np.isin(group.reshape(-1), may_touch)
    corners = assembly.positions[assembly.surface.triangles[ordered[rows]]]
    numbered = np.searchsorted(may_touch, group.reshape(-1)[rows]).astype(np.int32)
    touching = touching_from_outside(corners[:, 0], corners[:, 1], numbered)
    return frozenset((str(names[a]), str(names[b])) for a, b in both[may_touch[touching]].tolist())


def fresh_objects(context: bpy.types.Context, settings: EditSettings, known: KnownIntersections) -> set[str]:
    """Names of the objects in intersections that are not known."""
    found = known.fresh(find_intersections(context, settings))
    return {name for both in found.by_objects() for name in both}


def object_pair(pair: FacePair) -> ObjectPair:
    """The objects of a pair of elements."""
    return objects_of(pair.first, pair.second)


@dataclass(frozen=True)
class KnownIntersections:
    """Pairs of elements that intersect in the accepted state.

    Two objects that cut each other pass through each other until they are apart. Faces of one object that intersect
    stay as they are in each edit, and its other faces are guarded.
    """

    pairs: Sequence[FacePair] = ()

    @cached_property
    def objects(self) -> frozenset[ObjectPair]:
        """The pairs of objects."""
        return frozenset(FacePairs.of(self.pairs).by_objects())

    @cached_property
    def cutting_objects(self) -> frozenset[ObjectPair]:
        """The pairs of objects that cut each other, or themselves."""
        return frozenset(FacePairs.of(self.pairs).cutting().by_objects())

    def touching(self, copies: Mapping[str, str] | None = None) -> frozenset[ObjectPair]:
        """The pairs of objects that only touch. copies: see `left_out`."""
        return _with_copies(self.objects - self.cutting_objects, copies or {})

    def left_out(
        self, settings: EditSettings, copies: Mapping[str, str] | None = None, touching: bool = True
    ) -> EditSettings:
        """Settings of an edit that tests everything else.

        copies: names of objects that were copied, by the name of the copy; it passes through what the original did.
        touching: leave out objects that only touch, too.
        """
        known = self.objects if touching else self.cutting_objects
        pairs = _with_copies({pair for pair in known if pair[0] != pair[1]}, copies or {})
        return replace(settings, ignored_pairs=(*settings.ignored_pairs, *sorted(pairs)))

    def fresh(self, pairs: Iterable[FacePair]) -> FacePairs:
        """The pairs of objects that cut each other, and did not before."""
        listed = FacePairs.of(pairs).cutting()
        return listed.chosen(listed.where(lambda *both: objects_of(*both) not in self.cutting_objects))


def _with_copies(pairs: Collection[ObjectPair], copies: Mapping[str, str]) -> frozenset[ObjectPair]:
    """Pairs of objects, and the same with copies of one of the two. copies: names of originals, by that of the copy."""
    found = set(pairs)
    for copy, original in copies.items():
        others = [other for pair in found for other in pair if original in pair and other != original]
        found |= {(min(copy, other), max(copy, other)) for other in others}
    return frozenset(found)
