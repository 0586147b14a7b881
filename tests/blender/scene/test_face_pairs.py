# SPDX-License-Identifier: GPL-3.0-or-later
"""Pairs of faces of many pairs of triangles, against a list of names that is made one by one."""

from __future__ import annotations

from collections import Counter
from functools import lru_cache

import bpy
import numpy as np
from building import add, add_cube, add_grid, mesh
from hypothesis import given, settings
from hypothesis import strategies as st

from stiv.blender.scene.assembly import Assembly, assemble
from stiv.blender.scene.elements import FacePair
from stiv.blender.scene.evaluated_scene import read_scene
from stiv.blender.scene.face_pairs import find_face_pairs


@lru_cache(maxsize=1)
def some_meshes() -> Assembly:
    """Faces of one to five triangles, a mesh that occurs twice, and loose vertices inside another mesh."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
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
    assert [FacePair(*each) for each in found] == [pair for pair, _ in expected]
    for (a, b), number in zip(pairs, numbers.tolist(), strict=True):
        assert set(found[number]) == {assembly.face(a), assembly.face(b)}
    counts = np.bincount(numbers, minlength=len(found)).tolist()
    assert counts == [count for _, count in expected]


def test_loose_elements_are_named_beside_faces() -> None:
    assembly = some_meshes()
    found = find_face_pairs(assembly, assembly.positions)
    kinds = Counter((pair.first.kind, pair.second.kind) for pair in found)
    assert set(kinds) == {("face", "face"), ("edge", "face")} and len(set(found)) == len(found)
    assert {pair.first.object for pair in found if pair.first.kind == "edge"} == {"Loose"}
    assert all(FacePair(pair.second, pair.first) not in set(found) or pair.first == pair.second for pair in found)
