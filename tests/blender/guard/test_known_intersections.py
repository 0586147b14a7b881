# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard where objects touch: a crate on the floor is guarded against it, and may stay in contact."""

from functools import partial
from itertools import combinations
from typing import Any

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, evaluated
from guarded_changes import guarded
from mathutils import Vector

from stiv.blender import EditSettings, find_intersections
from stiv.blender.scene import obstacle_choice

DEEPEST = 1e-5  # rounding of these coordinates
Pairs = set[tuple[str, str]]


def crate_on_the_floor() -> Any:
    """A crate of size 2 that stands exactly on the floor, whose top is at 0, and a wall with its face at 3."""
    add_grid("Floor", 8, 6)
    add_cube("Wall", (3.5, 0, 3), 1.0, scale=(0.5, 4, 2))
    return add_cube("Crate", (0, 0, 1))


def cutting() -> Pairs:
    return set(find_intersections(bpy.context, EditSettings()).cutting().by_objects())


def translated(ob: Any, *way: float) -> Any:
    """A change that moves an object."""
    return lambda: setattr(ob, "location", ob.location + Vector(way))


def edited(ob: Any, *way: float) -> Any:
    """A change that moves the lower vertices of an object."""

    def move() -> None:
        for vertex in ob.data.vertices:
            vertex.co += Vector(way) if vertex.co.z < 0 else Vector()
        ob.data.update()

    return move


@pytest.mark.parametrize(
    ("way", "place"),
    [
        ((0.75, 0.25, 0), (0.75, 0.25, 1)),
        ((0, 0, 2), (0, 0, 3)),
        ((0, 0, -0.5), (0, 0, 1)),
        ((0.5, 0, -9), (0.5, 0, 1)),
        ((4, 0.5, 0), (2, 0.5, 1)),
    ],
)
@pytest.mark.parametrize("large", [False, True])
def test_a_crate_slides_on_the_floor_and_never_enters_it(
    way: tuple[float, ...], place: tuple[float, ...], large: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In large scenes, objects that stay are obstacles beside the surface."""
    monkeypatch.setattr(obstacle_choice, "MIN_FACES", 1 if large else 50_000)
    crate = crate_on_the_floor()
    wanted = tuple(crate.location + Vector(way))
    outcome = guarded(translated(crate, *way))
    assert outcome.wrote is (wanted != place)
    assert tuple(crate.location) == pytest.approx(place, abs=0.02 if place[0] == 2 else DEEPEST)
    assert tuple(crate.location) == wanted or outcome.blocking
    assert evaluated(crate)[:, 2].min() > -DEEPEST and cutting() == set()


def test_turning_and_flat_scaling_on_the_floor_stay_exact_and_growth_stops() -> None:
    crate = crate_on_the_floor()
    assert not guarded(lambda: setattr(crate, "rotation_euler", (0, 0, 0.5))).wrote
    assert not guarded(lambda: setattr(crate, "scale", (0.7, 1.3, 1))).wrote
    assert guarded(lambda: setattr(crate, "scale", (1.05, 1.95, 1.5))).blocking == ["Floor"]
    assert evaluated(crate)[:, 2].min() > -DEEPEST and cutting() == set()


@pytest.mark.parametrize("large", [False, True])
def test_vertices_on_the_floor_slide_exactly_and_never_enter_it(large: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obstacle_choice, "MIN_FACES", 1 if large else 50_000)
    crate = crate_on_the_floor()
    assert not guarded(edited(crate, 0.5, 0.2, 0)).wrote
    assert guarded(edited(crate, 0, 0, -0.5)).blocking == ["Floor"]
    assert evaluated(crate)[:, 2].min() > -DEEPEST and cutting() == set()


def test_a_floor_stops_below_the_crate_on_it() -> None:
    crate_on_the_floor()
    floor = bpy.data.objects["Floor"]
    assert guarded(translated(floor, 0, 0, 0.5)).blocking == ["Crate"]
    assert floor.location.z < DEEPEST and cutting() == set()


def test_new_objects_may_touch_and_copies_do_not_enter_what_their_original_touches() -> None:
    crate = crate_on_the_floor()
    assert not guarded(lambda: bpy.ops.mesh.primitive_cube_add(size=1, location=(-2, -2, 0.5))).wrote

    def duplicate() -> None:
        copy = crate.copy()
        copy.location = (-2.5, 0, 0.5)
        bpy.context.collection.objects.link(copy)

    outcome = guarded(duplicate)
    assert outcome.corrected == ["Crate.001"] and outcome.blocking == ["Floor"]
    assert bpy.data.objects["Crate.001"].location.z == pytest.approx(1, abs=DEEPEST) and cutting() == set()


def test_an_object_that_crosses_the_floor_along_its_own_edges_does_not_only_touch() -> None:
    crate = crate_on_the_floor()
    crate.data.from_pydata(*_cross_section(evaluated(crate) - [0, 0, 1]))
    crate.location.z = 0
    bpy.context.view_layer.update()
    assert cutting() == {("Crate", "Floor")}


def _cross_section(corners: Any) -> tuple[list[Any], list[Any], list[Any]]:
    """A tube from z = -1 to 1 with a ring of edges at 0: each of its faces lies on one side of that plane."""
    crate = bpy.data.objects["Crate"]
    crate.data.clear_geometry()
    ring = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    points = [(x, y, z) for z in (-1, 0, 1) for x, y in ring]
    sides = [(4 * k + i, 4 * k + (i + 1) % 4, 4 * k + 4 + (i + 1) % 4, 4 * k + 4 + i) for k in (0, 1) for i in range(4)]
    return points, [], [(3, 2, 1, 0), *sides, (8, 9, 10, 11)]


def _depth(first: Any, second: Any) -> float:
    """How deep two boxes cut each other: the least overlap along the normals of their faces and products of edges."""
    corners = [evaluated(ob) for ob in (first, second)]
    frames = [np.array(ob.matrix_world.to_3x3().normalized()).T for ob in (first, second)]
    axes = [*frames[0], *frames[1], *(np.cross(a, b) for a in frames[0] for b in frames[1])]
    units = [axis / np.linalg.norm(axis) for axis in axes if np.linalg.norm(axis) > 1e-3]
    spans = [[(each @ axis).min() for each in corners] + [(each @ axis).max() for each in corners] for axis in units]
    return min(min(b - c, d - a) for a, c, b, d in spans)


@pytest.mark.parametrize("seed", range(6))
def test_boxes_that_touch_never_cut_after_random_tools(seed: int) -> None:
    """Boxes of a stack, moved, turned and scaled at random, are compared by their separating axes."""
    chance = np.random.default_rng(seed)
    places = [(x, y, z) for x in (0, 2) for y in (0, 2) for z in (1, 3)]
    boxes = [add_cube(f"Box {k}", place) for k, place in enumerate(places)]
    boxes.append(add_cube("Floor", (1, 1, -0.5), 0.5, scale=(12, 12, 1)))
    for _ in range(12):
        box, kind = boxes[chance.integers(8)], chance.choice(["move", "move", "turn", "scale"])
        if kind == "move":
            way = chance.choice([-1.5, -0.5, 0, 0, 0.5, 1.5], 3)
            guarded(translated(box, *way))
        elif kind == "turn":
            guarded(partial(setattr, box, "rotation_euler", (0, 0, chance.uniform(-0.5, 0.5))))
        else:
            guarded(partial(setattr, box, "scale", (chance.uniform(0.7, 1.3),) * 3))
        depths = {(a.name, b.name): _depth(a, b) for a, b in combinations(boxes, 2)}
        assert max(depths.values()) < DEEPEST, max(depths, key=depths.__getitem__)
