# SPDX-License-Identifier: GPL-3.0-or-later
"""Place: copies stand on the surface, apart from each other, by Blender's ray casts and the exact test."""

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, mesh, select, snapshot
from mathutils import Vector

import stiv
from stiv.blender import EditSettings, PlaceSettings, check_scene, nearest_pair, place

H = 0.01
EDIT = EditSettings(separation=H)


def hill() -> bpy.types.Object:
    ground = add_grid("Hill", 24, 6.0)
    for vertex in ground.data.vertices:
        vertex.co.z = np.sin(vertex.co.x) * np.cos(vertex.co.y)
    return ground


@pytest.mark.parametrize("align", [False, True])
def test_copies_stand_on_the_surface_and_touch_nothing(align: bool) -> None:
    ground, stone = hill(), add_cube("Stone", (20, 0, 0), 0.3, rotation_euler=(0, 0, 0.5))
    select(stone, ground)
    settings = PlaceSettings(EDIT, count=15, seed=4, align=align, scale_variation=0.4)
    report = place(bpy.context, settings)
    bpy.context.view_layer.update()
    copies = [bpy.data.objects[name] for name in report.changed]
    assert report.asked == 15 and len(copies) >= 12 and all(copy.data == stone.data for copy in copies)
    assert not check_scene(bpy.context).pairs
    assert nearest_pair(bpy.context).distance >= H * (1 - 1e-3)
    scales = [copy.scale[0] / stone.scale[0] for copy in copies]
    assert 0.6 <= min(scales) < 0.9 < 1.1 < max(scales) <= 1.4
    for copy in copies:
        up = (copy.matrix_world.to_3x3() @ Vector((0, 0, 1))).normalized()
        assert align or up.z == pytest.approx(1, abs=1e-5)
        hit, point, *_ = ground.ray_cast(copy.matrix_world.translation, -up)
        assert hit and (copy.matrix_world.translation - point).length < 0.3 * 1.4 * 2


def test_a_crowded_surface_takes_fewer_and_says_so() -> None:
    ground, stone = add_grid("Floor", 1, 2.0), add_cube("Stone", (20, 0, 0), 0.5)
    select(stone, ground)
    report = place(bpy.context, PlaceSettings(EDIT, count=40))
    assert 4 <= len(report.changed) < 40 and not check_scene(bpy.context).pairs
    assert len(bpy.data.objects) == 2 + len(report.changed)


def test_the_same_seed_gives_the_same_copies_and_data_can_be_its_own() -> None:
    places = []
    for _ in range(2):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        ground, stone = hill(), add_cube("Stone", (20, 0, 0), 0.3)
        select(stone, ground)
        copies = place(bpy.context, PlaceSettings(EDIT, count=4, seed=9, linked=False)).changed
        places.append([tuple(bpy.data.objects[name].location) for name in copies])
        assert len({bpy.data.objects[name].data.name for name in copies} | {stone.data.name}) == 5
    assert places[0] == places[1]


def test_children_are_copied_with_their_parent() -> None:
    ground, stone = hill(), add_cube("Stone", (20, 0, 0), 0.3)
    moss = add_cube("Moss", (0, 0, 0.6), 0.1, parent=stone)
    select(stone, ground)
    copies = place(bpy.context, PlaceSettings(EDIT, count=3)).changed
    assert [len(bpy.data.objects[name].children) for name in copies] == [1] * len(copies) and len(copies) == 3
    assert moss.parent == stone and not check_scene(bpy.context).pairs


def test_an_object_that_its_parent_shears_is_refused_by_name() -> None:
    """A copy without the parent has another shape."""
    parent = add_cube("Parent", (20, 0, 0), 0.5, scale=(3, 1, 1))
    stone = add_cube("Stone", size=0.5, parent=parent, rotation_euler=(0, 0, 0.7))
    select(stone, add_grid("Ground", 8, 5.0))
    bpy.context.view_layer.update()
    before = snapshot()
    with pytest.raises(stiv.InputError, match="Stone: its parent shears it; apply its transform"):
        place(bpy.context, PlaceSettings(EDIT))
    assert snapshot() == before


def test_without_a_surface_or_cancelled_nothing_is_added() -> None:
    stone = add_cube("Stone", (20, 0, 0), 0.5)
    select(stone)
    with pytest.raises(stiv.InputError, match="no surface to place on"):
        place(bpy.context, PlaceSettings(EDIT))
    points = add("Points", mesh("Points", [(0, 0, 0), (1, 0, 0)], []))
    select(stone, points)
    with pytest.raises(stiv.InputError, match="no surface to place on"):
        place(bpy.context, PlaceSettings(EDIT))
    bpy.data.objects.remove(points)
    select(stone, hill())
    token = stiv.CancelToken()
    report = place(bpy.context, PlaceSettings(EDIT), cancel=token, progress=lambda *_: token.cancel())
    assert report.status == "cancelled" and len(bpy.data.objects) == 2


def test_copies_of_a_mesh_that_intersects_itself_stay() -> None:
    stone = add_cube("Stone", (20, 0, 0), 0.3)
    other = add_cube("Other", (20.1, 0.1, 0.1), 0.3)
    with bpy.context.temp_override(active_object=stone, selected_editable_objects=[stone, other]):
        bpy.ops.object.join()
    select(stone, hill())
    assert len(place(bpy.context, PlaceSettings(EDIT, count=4)).changed) == 4
