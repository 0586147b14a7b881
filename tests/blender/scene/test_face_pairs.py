# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of faces of many pairs of triangles, and pairs as arrays, against lists that are made one by one."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from functools import lru_cache

import bpy
import numpy as np
from building import add, add_cube, add_grid, mesh
from hypothesis import given, settings
from hypothesis import strategies as st

from stiv.blender.scene.assembly import Assembly, assemble
from stiv.blender.scene.elements import Element, FacePair, FacePairs, count_faces
from stiv.blender.scene.evaluated_scene import read_scene
from stiv.blender.scene.evaluations import EVALUATIONS, SHOWN
from stiv.blender.scene.face_pairs import find_face_pairs


@lru_cache(maxsize=1)
def some_meshes() -> Assembly:
    """Faces of one to five triangles, a mesh that occurs twice, and loose vertices inside another mesh."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    angles = np.linspace(0, 2 * np.pi, 7, endpoint=False)
    disc = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    add("Disc", mesh("Disc", disc, [tuple(range(7))]))
    add_cube("Cube", (0.2, 0, 0.1), 1.0)
    add_grid("Grid", 3)
    add("Loose", mesh("Loose", [(0.2, 0, 0.6), (0.2, 0, -0.4)], [], edges=[(0, 1)]))
    bpy.context.view_layer.update()
    meshes = list(read_scene(bpy.context).meshes)
    return assemble([*meshes, meshes[0]], ["deformable"] * (len(meshes) + 1))


def counted(assembly: Assembly, pairs: list[tuple[int, int]]) -> list[tuple[FacePair, int]]:
    """Each pair of faces in either order, and its number of pairs of triangles."""
    counts: Counter[FacePair] = Counter()
    for a, b in pairs:
        pair, other = FacePair(assembly.face(a), assembly.face(b)), FacePair(assembly.face(b), assembly.face(a))
        counts[other if other in counts else pair] += 1
    return list(counts.items())


@settings(deadline=None)
@given(st.data())
def test_pairs_of_faces_are_those_of_single_triangles(data: st.DataObject) -> None:
    assembly = some_meshes()
    triangle = st.integers(0, len(assembly.surface.triangles) - 1)
    pairs = data.draw(st.lists(st.tuples(triangle, triangle), max_size=40))
    found, numbers = assembly.face_pairs(np.array(pairs, np.int32).reshape(-1, 2))
    expected = counted(assembly, pairs)
    assert list(found) == [pair for pair, _ in expected]
    for (a, b), number in zip(pairs, numbers.tolist(), strict=True):
        assert {found[number].first, found[number].second} == {assembly.face(a), assembly.face(b)}
    assert [pair.triangle_pairs for pair in found] == [count for _, count in expected]


elements = st.builds(
    Element, st.sampled_from("AB"), st.sampled_from(["face", "edge"]), st.integers(0, 3), st.sampled_from(EVALUATIONS)
)
face_pairs = st.lists(st.builds(FacePair, elements, elements, st.integers(1, 3)), max_size=12)


@given(face_pairs, face_pairs)
def test_pairs_as_arrays_are_those_of_a_list(some: list[FacePair], others: list[FacePair]) -> None:
    pairs = FacePairs.of(some)
    assert pairs == some and list(pairs) == some and pairs[2:5] == some[2:5] and (pairs == others) == (some == others)
    assert pairs.triangle_pairs.tolist() == [pair.triangle_pairs for pair in some]
    same_kind = pairs.where(lambda first, second: first.kind == second.kind)
    assert pairs.chosen(same_kind) == [pair for pair in some if pair.first.kind == pair.second.kind]
    by_objects: dict[tuple[str, ...], list[FacePair]] = {}
    for pair in some:
        by_objects.setdefault(tuple(sorted((pair.first.object, pair.second.object))), []).append(pair)
    assert list(pairs.by_objects().items()) == list(by_objects.items())
    touching = frozenset(names for names in by_objects if names[0] != names[1])
    marked = FacePairs(pairs.owners, pairs.owner, pairs.number, pairs.triangle_pairs, touching)
    assert marked[1:].cutting() == [pair for pair in some[1:] if pair.first.object == pair.second.object]
    assert pairs.sides() == {frozenset((pair.first.object, pair.second.object)) for pair in some}
    faces = {each for pair in some for each in (pair.first, pair.second) if each.kind == "face"}
    assert {replace(owner, number=n) for owner, numbers in pairs.faces() for n in numbers.tolist()} == faces
    assert count_faces(some) == (sum(each.evaluation == SHOWN for each in faces) or len(faces))
    counts: Counter[FacePair] = Counter()
    for pair in [*some, *others]:
        turned = FacePair(pair.second, pair.first)
        counts[turned if turned in counts else pair] += pair.triangle_pairs
    joined = FacePairs.of(some).joined(others)
    if others:
        assert [(pair, pair.triangle_pairs) for pair in joined] == list(counts.items())


def test_loose_elements_are_named_beside_faces() -> None:
    assembly = some_meshes()
    found = find_face_pairs(assembly, assembly.positions)
    kinds = Counter((pair.first.kind, pair.second.kind) for pair in found)
    assert set(kinds) == {("face", "face"), ("edge", "face")} and len(set(found)) == len(found)
    assert {pair.first.object for pair in found if pair.first.kind == "edge"} == {"Loose"}
    assert all(FacePair(pair.second, pair.first) not in set(found) or pair.first == pair.second for pair in found)
