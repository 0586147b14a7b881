# SPDX-License-Identifier: GPL-3.0-or-later
"""Skin in parts: regions around joints that turn, and limbs, which share no vertex and are tested."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid

from stiv.blender.controls.joint_regions import Joint, Regions, Skin, divide, divide_all
from stiv.blender.scene.evaluated_scene import VisibleMesh, read_scene
from stiv.seams import find_seams

FIRST = Joint(np.array([-2.0, 0, 0]), frozenset({"B", "C"}))
SECOND = Joint(np.array([2.0, 0, 0]), frozenset({"C"}))


def strip() -> Skin:
    """A strip of 48 x 48 quads from -6 to 6, 1.2 wide, whose bones A, B and C meet at x = -2 and x = 2."""
    ob = add_grid("Strip", 48, 6.0, scale=(1, 0.1, 1))
    mesh = read_scene(bpy.context).meshes[0]
    x = mesh.world()[:, 0]
    b = np.clip((x + 2.25) / 0.5, 0, 1) - np.clip((x - 1.75) / 0.5, 0, 1)
    c = np.clip((x - 1.75) / 0.5, 0, 1)
    assert ob.name == mesh.owner.name
    return Skin(mesh, ["A", "B", "C"], np.stack([1 - b - c, b, c], axis=1))


def faces_of(regions: Regions) -> list[set[int]]:
    return [set(part.faces.tolist()) for part in regions.parts]


def vertices_of(part: VisibleMesh) -> set[int]:
    assert part.cropped is not None
    return set(part.cropped.vertices.tolist())


@pytest.mark.parametrize("joints", [[FIRST], [FIRST, SECOND]])
def test_parts_are_a_partition_and_tested_ones_share_no_vertex(joints: list[Joint]) -> None:
    skin = strip()
    regions = divide(skin, joints, 2.5).regions
    found = faces_of(regions)
    assert regions.joints == len(joints) and len(found) == 4 * len(joints) + 1
    assert sum(map(len, found)) == len(set().union(*found)) == 48 * 48
    assert sum(len(part.triangles) for part in regions.parts) == len(skin.mesh.triangles)
    for a, first in enumerate(regions.parts):
        world = skin.mesh.world()[first.cropped.vertices] if first.cropped is not None else None
        assert np.array_equal(first.world(), world)
        for b, second in enumerate(regions.parts[:a]):
            is_tested = not {(a, b), (b, a)} & regions.untested
            assert is_tested == (not vertices_of(first) & vertices_of(second))


def test_each_loose_edge_lies_in_one_part_with_its_neighbours() -> None:
    """Edges along the strip, one inside each region and limb, across their borders, and one apart from the strip."""
    skin = strip()
    count, along = len(skin.mesh.local), np.argsort(skin.mesh.world()[:, 0]).astype(np.int32)
    pairs = np.stack([along[:-60:60], along[60::60][: len(along[:-60:60])]], axis=1)
    edges = np.concatenate([pairs, [[count, count + 1]]]).astype(np.int32)
    local = np.concatenate([skin.mesh.local, np.array([[0, 9, 0], [0, 9, 1]], np.float32)])
    numbers = np.arange(7, 7 + len(edges), dtype=np.int32)
    mesh = replace(skin.mesh, local=local, loose_edges=edges, loose_numbers=numbers)
    weights = np.concatenate([skin.weights, [[0, 1, 0], [0, 1, 0]]])
    regions = divide(Skin(mesh, skin.groups, weights), [FIRST, SECOND], 2.5).regions
    assert sorted(np.concatenate([part.loose_numbers for part in regions.parts]).tolist()) == numbers.tolist()
    for a, first in enumerate(regions.parts):
        assert first.cropped is not None
        for edge, number in zip(first.cropped.vertices[first.loose_edges], first.loose_numbers.tolist(), strict=True):
            assert edge.tolist() == edges[number - 7].tolist()
        for b, second in enumerate(regions.parts[:a]):
            if not {(a, b), (b, a)} & regions.untested:
                assert not vertices_of(first) & vertices_of(second)


def test_regions_grow_with_their_radius_and_vanish_at_0() -> None:
    skin = strip()
    sizes = [divide(skin, [FIRST], radii).regions.faces for radii in (0.0, 0.9, 1.5, 2.5)]
    assert sizes[0] == 0 and sizes == sorted(set(sizes))
    assert divide(skin, [FIRST], 0.0).regions.parts == (skin.mesh,)
    yielding = Joint(FIRST.head, FIRST.bones, yields=True)
    assert divide(skin, [yielding], 2.5).regions.faces == sizes[2]


def test_copies_on_closed_seams_do_not_change_the_parts() -> None:
    """Each quad has vertices of its own; as one surface, the strip has the parts of the strip without copies."""
    skin = strip()
    mesh, order = skin.mesh, np.unique(np.stack([skin.mesh.triangles.ravel(), np.repeat(skin.mesh.faces, 3)]), axis=1)
    vertex, face = order
    place = {tuple(key): number for number, key in enumerate(order.T.tolist())}
    corners = np.array([
        [place[corner, owner] for corner in row]
        for row, owner in zip(mesh.triangles.tolist(), mesh.faces.tolist(), strict=True)
    ], np.int32)  # fmt: skip
    split = replace(mesh, local=mesh.local[vertex], triangles=corners)
    seams = find_seams(split.local, corners)
    assert len(face) == len(split.local) == 4 * 48 * 48 and seams is not None
    regions = divide(Skin(split, skin.groups, skin.weights[vertex], seams), [FIRST, SECOND], 2.5).regions
    assert faces_of(regions) == faces_of(expected := divide(skin, [FIRST, SECOND], 2.5).regions)
    assert (regions.untested, regions.joints) == (expected.untested, expected.joints)


def test_a_mesh_that_bends_without_weights_is_not_tested_against_itself() -> None:
    add_cube("Cube")
    mesh = read_scene(bpy.context).meshes[0]
    stretched, moved = np.zeros((8, 3, 1)), np.ones((8, 3, 1))
    stretched[:, 0, 0] = mesh.world()[:, 0]
    for jacobian, expected in ((stretched, {(0, 0)}), (moved, set())):
        regions = divide_all([mesh], [([], np.zeros((8, 0)))], [], jacobian, 2.0)
        assert regions[0].untested == expected and regions[0].parts == (mesh,)
