# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves and NURBS surfaces moved by their points: as Blender evaluates them, and free."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_modifier, edit_mode, evaluated, moved, select, shift, turn

import stiv
from stiv.blender import AcceptedScene, BlenderEdit, EditSettings, check_scene, guard_result
from stiv.blender.scripts.selection import select as select_step
from stiv.edit_scripts import EditStep

DEFORM = EditSettings(object_response="deform")


def add_bezier(handles: str) -> Any:
    """A bevelled wave of Bezier points."""
    data = bpy.data.curves.new("Wäve", "CURVE")
    data.dimensions, data.bevel_depth, data.resolution_u, data.render_resolution_u = "3D", 0.1, 4, 6
    spline = data.splines.new("BEZIER")
    spline.bezier_points.add(3)
    for number, point in enumerate(spline.bezier_points):
        point.co = number - 1.5, number % 2, 0
        point.handle_left_type = point.handle_right_type = "AUTO"
    ob = add("Wäve", data, (0, 0, 2), rotation_euler=(0.1, 0.2, 0.3))
    for point in spline.bezier_points:
        point.handle_left_type = point.handle_right_type = handles
    bpy.context.view_layer.update()
    return ob


def add_nurbs(kind: str) -> Any:
    """A NURBS tube or sphere."""
    if kind == "surface":
        bpy.ops.surface.primitive_nurbs_surface_sphere_add(location=(0, 0, 2))
    else:
        bpy.ops.curve.primitive_nurbs_circle_add(location=(0, 0, 2))
        bpy.context.object.data.bevel_depth = 0.2
    bpy.context.object.data.resolution_u = 3
    return bpy.context.object


def add_flat() -> Any:
    """A 2D curve without a fill, in a tilted plane."""
    ob = add_bezier("FREE")
    ob.data.extrude = 0.05
    ob.data.dimensions, ob.data.fill_mode = "2D", "NONE"
    bpy.context.view_layer.update()
    return ob


def add_tapered() -> Any:
    """A tube that ends in points, where vertices coincide."""
    ob, taper = add_bezier("FREE"), bpy.data.curves.new("Taper", "CURVE")
    spline = taper.splines.new("POLY")
    spline.points.add(2)
    for place, point in zip((-1, 0, 1), spline.points, strict=True):
        point.co = place, 1 - place * place, 0, 1
    ob.data.taper_object = add("Taper", taper, (30, 0, 0))
    bpy.context.view_layer.update()
    return ob


def add_thick() -> Any:
    """A NURBS surface whose modifier makes it follow its points in other ways than linearly."""
    bpy.ops.surface.primitive_nurbs_surface_surface_add(location=(0, 0, 2))
    add_modifier(bpy.context.object, "SOLIDIFY", thickness=0.1)
    bpy.context.object.data.resolution_u = bpy.context.object.data.resolution_v = 2
    return bpy.context.object


MAKERS = {
    "free": lambda: add_bezier("FREE"),
    "aligned": lambda: add_bezier("ALIGNED"),
    "auto": lambda: add_bezier("AUTO"),
    "curve": lambda: add_nurbs("curve"),
    "flat": add_flat,
    "tapered": add_tapered,
    "thick": add_thick,
    "surface": lambda: add_nurbs("surface"),
}


def points(ob: Any) -> list[tuple[float, ...]]:
    """All stored points, to the last bit."""
    found = []
    for spline in ob.data.splines:
        found += [tuple(point.co) for point in spline.points]
        found += [(*each.handle_left, *each.co, *each.handle_right) for each in spline.bezier_points]
    return found


def choose(ob: Any, count: int) -> None:
    """Select the first points alone, not those at a pole."""
    for spline in ob.data.splines:
        chosen = [point for point in spline.points if abs(point.co.x) + abs(point.co.y) > 0.5][:count]
        for point in spline.points:
            point.select = point in chosen
        for number, point in enumerate(spline.bezier_points):
            point.select_control_point = point.select_left_handle = point.select_right_handle = number < count


def begin(settings: EditSettings = DEFORM, kind: str = "move") -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings, kind)


@pytest.mark.parametrize("made", MAKERS)
def test_without_contact_the_points_end_where_blender_puts_them(made: str) -> None:
    ob = MAKERS[made]()
    edit_mode(ob)
    choose(ob, 2)
    before = points(ob)
    edit = begin()
    assert points(ob) == before
    edit.apply(shift(0.1, 0.2, 0.4))
    assert edit.write().passed
    mine, shown = points(ob), evaluated(ob)
    edit.restore()
    assert points(ob) == before
    bpy.ops.transform.translate(value=(0.1, 0.2, 0.4))
    assert np.ravel(mine) == pytest.approx(np.ravel(points(ob)), abs=1e-5)
    assert shown == pytest.approx(evaluated(ob), abs=1e-5)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("made", MAKERS)
def test_the_surface_stops_at_the_floor(made: str, mode: str) -> None:
    """A pointed floor, so that the surface has to deform."""
    ob = MAKERS[made]()
    floor = add_grid("Floor", 6, 4.0)
    for vertex in floor.data.vertices:
        vertex.co.z = 0.5 - 0.3 * np.hypot(vertex.co.x, vertex.co.y)
    select(ob) if mode == "OBJECT" else edit_mode(ob)
    if mode == "EDIT":
        choose(ob, 3)
    start = evaluated(ob)
    edit = begin()
    for step in (1.0, 2.0, 3.0):
        edit.drag(shift(0.05, 0, -step))
        assert edit.write().passed
        assert check_scene(bpy.context, DEFORM).pairs == ()
        assert check_scene(bpy.context, EditSettings(guard="render")).pairs == ()
    assert np.abs(evaluated(ob) - start)[:, 2].max() > {"flat": 0.1, "thick": 0.4}.get(made, 0.9)
    if made == "flat":
        assert np.abs(np.reshape(points(ob), (-1, 3))[:, 2]).max() == 0
    if mode == "EDIT":
        bpy.ops.object.mode_set(mode="OBJECT")
        assert check_scene(bpy.context, DEFORM).pairs == ()


def test_object_mode_turns_all_points_about_the_origin() -> None:
    ob = add_nurbs("surface")
    add_modifier(ob, "SUBSURF", levels=1)
    select(ob)
    start, transform = evaluated(ob), turn(0.5, "Y", ob.location)
    edit = begin(kind="rotate")
    edit.apply(transform)
    assert edit.write().passed
    assert evaluated(ob) == pytest.approx(moved(transform, start), abs=1e-5)


def test_what_cannot_follow_its_points_is_refused_by_name() -> None:
    data = bpy.data.curves.new("Text", "FONT")
    data.body = "Text"
    text = add("Text", data)
    select(text)
    bpy.ops.object.mode_set(mode="EDIT")
    refused("Text: text has no points; use Object Mode")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert begin().apply(shift(1)).status == "reached"
    bpy.ops.curve.primitive_bezier_circle_add(location=(0, 9, 0))
    circle = bpy.context.object
    circle.data.dimensions, circle.data.fill_mode = "2D", "BOTH"
    select(circle)
    bpy.context.view_layer.update()
    refused(f"{circle.name}: its fill changes its faces; convert it to a mesh")
    circle.data.dimensions, circle.data.bevel_depth = "3D", 0.1
    add_modifier(circle, "REMESH", voxel_size=0.1)
    refused(f'{circle.name}: Remesh "Remesh" changes topology; apply it')
    circle.modifiers.clear()
    circle.shape_key_add(name="Basis")
    refused(f"{circle.name}: its shape keys hide edits; apply all shape keys")


def test_a_modifier_that_uses_another_object_that_moves_is_refused_by_name() -> None:
    curve, cube = add_nurbs("curve"), add_cube("Cube", (9, 0, 0))
    add_modifier(curve, "SIMPLE_DEFORM", angle=0.3, origin=cube)
    select(curve, cube)
    with pytest.raises(stiv.InputError, match=f'{curve.name}: Simple Deform "Simple_Deform" uses "Cube"; deselect one'):
        begin()


def refused(message: str) -> None:
    assert len(message) <= 80
    with pytest.raises(stiv.InputError, match=message):
        begin()


@pytest.mark.parametrize("made", ["aligned", "auto", "surface"])
def test_the_live_guard_corrects_what_blender_moved(made: str) -> None:
    ob = MAKERS[made]()
    add_grid("Floor", 2, 4.0)
    edit_mode(ob)
    choose(ob, 2)
    accepted, start = AcceptedScene.read(bpy.context), points(ob)
    bpy.ops.transform.translate(value=(0.1, 0, -3))
    assert check_scene(bpy.context).pairs
    assert guard_result(bpy.context, EditSettings(), accepted).corrected == [ob.name]
    assert check_scene(bpy.context).pairs == ()
    assert np.abs(np.ravel(points(ob)) - np.ravel(start)).max() > 0.5


def test_the_live_guard_reports_a_curve_with_other_points() -> None:
    ob = add_bezier("ALIGNED")
    add_grid("Floor", 2, 4.0)
    edit_mode(ob)
    accepted = AcceptedScene.read(bpy.context)
    ob.data.splines[0].bezier_points.add(1)
    ob.data.splines[0].bezier_points[4].co.z = -5
    bpy.context.view_layer.update()
    result = guard_result(bpy.context, EditSettings(), accepted)
    assert result.reason == "Wäve has another structure"
    assert result.pairs


def test_edit_scripts_select_points_and_handles() -> None:
    ob = add_bezier("FREE")
    select_step(EditStep("move", "EDIT", (ob.name,), {}, points=(0, 1, 2, 5)))
    first, second, third, last = (
        (each.select_left_handle, each.select_control_point, each.select_right_handle)
        for each in ob.data.splines[0].bezier_points
    )
    assert (first, second, third, last) == ((True,) * 3, (False, False, True), (False,) * 3, (False,) * 3)
    surface = add_nurbs("surface")
    select_step(EditStep("move", "EDIT", (surface.name,), {}, points=(3,)))
    assert [number for number, point in enumerate(surface.data.splines[0].points) if point.select] == [3]
