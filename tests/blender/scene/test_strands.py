# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves and hair as obstacles of edits, and in checks."""

from itertools import pairwise
from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_modifier, edit_mode, select, shift
from mathutils import Vector

from stiv.blender import BlenderEdit, EditSettings, check_scene
from stiv.blender.scene.evaluations import EVALUATIONS
from stiv.blender.verify.frame_check import check_frames
from stiv.blender.verify.untested import unguarded_text

RADIUS = 0.2
LINE = np.array([(2.0, 0.3, -4.0), (2.0, 0.3, -0.2), (2.4, 0.1, 4.0)])  # beside a cube of half width 1


def bare_curve(points: Any = LINE) -> Any:
    data = bpy.data.curves.new("Wire", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY")
    spline.points.add(len(points) - 1)
    spline.points.foreach_set("co", np.c_[points, np.ones(len(points))].ravel())
    return add("Wire", data)


def hair_curves(points: Any = LINE) -> Any:
    data = bpy.data.hair_curves.new("Hair")
    data.add_curves([len(points)])
    data.attributes["position"].data.foreach_set("vector", np.ravel(points).astype(np.float32))
    data.attributes.new("radius", "FLOAT", "POINT").data.foreach_set("value", np.full(len(points), RADIUS, np.float32))
    return add("Hair", data)


def smooth(points: np.ndarray) -> np.ndarray:
    """A Catmull-Rom curve through points, (n, 3), sampled densely."""
    spans = np.concatenate([points[:1], points, points[-1:]])
    t = np.linspace(0, 1, 500)[:, None]
    return np.concatenate([
        b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))
        for a, b, c, d in zip(spans[:-3], spans[1:-2], spans[2:-1], spans[3:], strict=True)
    ])  # fmt: skip


def particle_hair(location: Any = (2.3, 0, -3), **properties: Any) -> Any:
    """A lawn the hairs of which, 6 long, stand beside the cube."""
    lawn = add_grid("Lawn", 2, 0.2, location, **properties)
    settings = add_modifier(lawn, "PARTICLE_SYSTEM").particle_system.settings
    settings.type, settings.count, settings.hair_length = "HAIR", 20, 6.0
    settings.radius_scale, settings.root_radius = 0.02, 2.0
    bpy.context.view_layer.update()
    return lawn


def hair_points(lawn: Any) -> np.ndarray:
    """The polylines of particle hair, (k, 5, 3), as keys of Blender's own."""
    evaluated = lawn.evaluated_get(bpy.context.evaluated_depsgraph_get())
    system = evaluated.particle_systems[0]
    return np.array([[system.co_hair(evaluated, particle_no=k, step=s) for s in range(5)] for k in range(20)])


def distance_to(points: np.ndarray, cube: Any) -> float:
    """The least distance of a polyline, sampled densely, to a cube of half width 1 wherever it stands."""
    t = np.linspace(0, 1, 2001 if len(points) < 50 else 3)[:, None]
    samples = np.concatenate([a + t * (b - a) for a, b in pairwise(points)])
    seen = np.c_[samples, np.ones(len(samples))] @ np.array(cube.matrix_world.inverted()).T
    return float(np.linalg.norm(np.maximum(np.abs(seen[:, :3]) - 1, 0), axis=1).min())


def pushed(cube: Any, **settings: Any) -> BlenderEdit:
    """Along x only: the goal, far behind a strand, could be reached around it."""
    select(cube)
    cube.lock_location = (False, True, True)
    edit = BlenderEdit.begin(bpy.context, EditSettings(**settings), "move")
    edit.apply(shift(x=4))
    assert edit.write().passed
    bpy.context.view_layer.update()
    return edit


@pytest.mark.parametrize("make", [bare_curve, hair_curves])
def test_an_object_stops_at_a_strand(make: Any) -> None:
    cube = add_cube("Cube")
    make()
    line, radius = (smooth(LINE), RADIUS) if make is hair_curves else (LINE, 0.0)
    assert distance_to(line, cube) > radius
    pushed(cube)
    assert cube.location.x > 0.5 and np.linalg.norm(cube.location - Vector((4, 0, 0))) > 1
    assert distance_to(line, cube) >= radius
    assert check_scene(bpy.context).pairs == ()
    assert unguarded_text(bpy.context, EVALUATIONS) == ""


def test_vertices_stop_at_a_strand() -> None:
    cube = add_cube("Cube")
    bare_curve(np.array([(2.0, 0.3, -4.0), (2.0, 0.3, 4.0)]))
    edit_mode(cube)
    bpy.ops.mesh.select_all(action="SELECT")
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.apply(shift(x=1.5))
    assert edit.write().passed
    bpy.ops.object.mode_set(mode="OBJECT")
    corners = np.array([vertex.co for vertex in cube.data.vertices])
    assert corners[:, 0].max() > 1.9 and not np.allclose(corners[4:, 0], 2.5)
    assert check_scene(bpy.context).pairs == ()


def test_a_smooth_hair_keeps_its_bulge_free() -> None:
    """A Catmull-Rom curve reaches beyond the straight lines between its points."""
    points = np.array([(3.0, 0, -3), (2.0, 0, -0.5), (2.0, 0, 0.5), (3.0, 0, 3)])
    hair_curves(points)
    cube = add_cube("Cube")
    pushed(cube)
    assert smooth(points)[:, 0].min() < 1.9
    assert 0.4 < cube.location.x < 1 and distance_to(smooth(points), cube) >= RADIUS


def test_an_object_stops_at_particle_hair() -> None:
    cube, lawn = add_cube("Cube"), particle_hair()
    hairs = hair_points(lawn)
    pushed(cube)
    least = min(distance_to(hair, cube) for hair in hairs)
    assert 0.02 <= least < 0.1 and cube.location.x > 0.5
    lawn.modifiers[0].particle_system.settings.render_type = "NONE"
    bpy.context.view_layer.update()
    pushed(cube)
    assert cube.location.x > 4


def test_strands_that_move_along_are_not_obstacles_and_named() -> None:
    """A hairy cube, hair hanging on it, and a lawn: the selection takes its own along."""
    cube, wire, lawn = add_cube("Cube"), bare_curve(), particle_hair((0, 0, 3))
    wire.parent = lawn.parent = cube
    edit = pushed(cube)
    assert cube.location.x == pytest.approx(4)
    assert edit.carried == {"Wire", "Lawn"}
    said = 'Not guarded, hair and curves that move along: 2 ("Lawn", "Wire")'
    assert unguarded_text(bpy.context, EVALUATIONS, edit.carried) == said


@pytest.mark.parametrize(("make", "name"), [(bare_curve, "Wire"), (hair_curves, "Hair"), (particle_hair, "Lawn")])
def test_check_reports_intersections_with_strands(make: Any, name: str) -> None:
    make()
    cube = add_cube("Cube", (2, 0, 0))
    found = check_scene(bpy.context)
    assert found.untested == () and found.objects == 2
    assert {(each.object, each.kind) for pair in found.pairs for each in (pair.first, pair.second)} == {
        ("Cube", "face"), (name, "strand"),
    }  # fmt: skip
    select(cube)
    assert check_scene(bpy.context, EditSettings(roles={name: "ignored"})).pairs == ()
    bpy.data.objects[name].parent = cube
    bpy.context.view_layer.update()
    assert check_scene(bpy.context).pairs == ()  # hair intersects its own surface


def test_helper_curves_are_not_obstacles_and_named() -> None:
    wire, cube = bare_curve(), add_cube("Cube")
    add_modifier(add_cube("Bent", (0, 9, 0)), "CURVE", object=wire)
    pushed(cube)
    assert cube.location.x == pytest.approx(4)
    assert unguarded_text(bpy.context, EVALUATIONS) == 'Not guarded, helper curves: 1 ("Wire")'


def test_too_many_segments_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    hair_curves()
    particle_hair()
    monkeypatch.setattr("stiv.blender.scene.strand_reading.MAX_SEGMENTS", 1)
    cube = add_cube("Cube")
    pushed(cube)
    assert cube.location.x == pytest.approx(4)
    assert {(each.object, each.reason) for each in check_scene(bpy.context).untested} == {
        ("Hair", "hair curves of more than 1 segments"), ("Lawn", "particle hair of more than 1 segments"),
    }  # fmt: skip


def test_static_strands_are_tested_between_frames_and_others_named() -> None:
    """A cube jumps over a wire that stays; hair that moves by itself is not followed."""
    bare_curve()
    hair = hair_curves(LINE + np.array([0, 20, 0]))
    for ob, end in ((add_cube("Cube"), 6), (hair, 1)):
        for frame, x in ((1, 0), (2, end)):
            ob.location.x = x
            ob.keyframe_insert("location", frame=frame)
    looks = list(check_frames(bpy.context, (1, 2)))
    found = [each for look in looks for each in look.findings]
    assert found and {each.kind for each in found} == {"crossing"}
    assert {(end.object, end.kind) for each in found for end in (each.first, each.second)} >= {("Wire", "strand")}
    assert {name for each in found for name in each.objects} == {"Cube", "Wire"}
    assert [note for look in looks for note in look.notes] == [
        'between frames 1 and 2: hair or curves of object "Hair" move, and were left out'
    ]


@pytest.mark.parametrize("guard", ["viewport", "render", "both"])
def test_particle_hair_is_an_obstacle_in_each_evaluation(guard: str) -> None:
    lawn, cube = particle_hair(), add_cube("Cube")
    add_modifier(cube, "SUBSURF", levels=1, render_levels=2)
    pushed(cube, guard=guard)
    assert 0.2 < np.linalg.norm(cube.location) < 3.9
    assert check_scene(bpy.context, EditSettings(guard=guard)).pairs == ()
    assert lawn.location.x == pytest.approx(2.3)
