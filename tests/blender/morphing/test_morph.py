# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of shape keys as controls: they stop at contact, within the sliders, as Blender evaluates them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import count
from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, evaluated, mesh

import stiv
from stiv.blender import EditSettings, Handles, MorphEdit, check_scene, morph
from stiv.blender.morphing import morph_edit

SETTINGS = EditSettings(separation=0.01)


def add_key(ob: Any, name: str, change: Callable[[Any], Any], relative: str = "", **properties: Any) -> Any:
    """A key that changes each point of the key to which it is relative."""
    if ob.data.shape_keys is None:
        ob.shape_key_add(name="Basis")
    block = ob.shape_key_add(name=name)
    blocks = ob.data.shape_keys.key_blocks
    block.relative_key = blocks[relative or "Basis"]
    for point, rest in zip(block.data, block.relative_key.data, strict=True):
        point.co = change(rest.co)
    for key, value in {"value": 0.0, **properties}.items():  # new keys have value 1 in Blender 5
        setattr(block, key, value)
    return block


def scaled(x: float = 1, y: float = 1, z: float = 1) -> Callable[[Any], Any]:
    return lambda co: (co[0] * x, co[1] * y, co[2] * z)


def ball_and_wall(distance: float = 2.0) -> Any:
    """A ball of radius 1, and a wall at this distance along x."""
    wall = add_grid("Wall", 4, 4.0, (distance, 0, 0))
    wall.rotation_euler[1] = np.pi / 2
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1, segments=16, ring_count=9)
    ball = bpy.context.object
    ball.name = "Ball"
    return ball


def widest(ob: Any) -> float:
    bpy.context.view_layer.update()
    return float(evaluated(ob)[:, 0].max())


def check_stopped(ob: Any, distance: float = 2.0) -> None:
    """The object is free, and as close to the wall as the minimum distance allows."""
    assert check_scene(bpy.context).pairs == ()
    assert distance - 0.03 < widest(ob) < distance - 0.005


def test_a_slider_stops_at_contact_and_goes_back() -> None:
    ball = ball_and_wall()
    wide = add_key(ball, "Wide", scaled(3))
    report = morph(bpy.context, {"Ball": {"Wide": 1.0}}, SETTINGS)
    assert report.status in ("corrected", "blocked")
    assert report.values == {("Ball", "Wide"): wide.value}
    check_stopped(ball)
    assert morph(bpy.context, {"Ball": {"Wide": 0.25}}, SETTINGS).status == "reached"
    assert wide.value == 0.25


def test_a_time_limit_ends_on_the_way_with_a_clear_state(monkeypatch: pytest.MonkeyPatch) -> None:
    ball = ball_and_wall()
    wide = add_key(ball, "Wide", scaled(3))
    clock = count(0, 100)  # each look at the clock of the increments takes long
    monkeypatch.setattr(morph_edit, "time", SimpleNamespace(monotonic=clock.__next__))
    report = morph(bpy.context, {"Ball": {"Wide": 1.0}}, replace(SETTINGS, time_budget=50.0))
    assert (report.status, report.values) == ("budget", {("Ball", "Wide"): wide.value})
    assert 0 < wide.value < 0.4 and check_scene(bpy.context).pairs == ()
    monkeypatch.undo()
    again = morph(bpy.context, {"Ball": {"Wide": 1.0}}, replace(SETTINGS, time_budget=1000.0))
    assert again.status in ("corrected", "blocked")
    check_stopped(ball)


def test_several_keys_at_once_never_pass_their_goals() -> None:
    ball = ball_and_wall()
    wide, tall = add_key(ball, "Wide", scaled(3)), add_key(ball, "Tall", scaled(z=2))
    morph(bpy.context, {"Ball": {"Wide": 1.0, "Tall": 0.5}}, SETTINGS)
    assert tall.value == pytest.approx(0.5, abs=1e-6)
    assert 0.4 < wide.value < 0.55
    check_stopped(ball)


def test_other_sliders_yield_if_asked() -> None:
    ball = ball_and_wall()
    wide = add_key(ball, "Wide", scaled(3))
    flat = add_key(ball, "Flat", scaled(0.5), slider_max=0.8)
    muted = add_key(ball, "Muted", scaled(0.1), mute=True)
    morph(bpy.context, {"Ball": {"Wide": 0.8}}, SETTINGS)
    alone = wide.value
    assert (flat.value, muted.value) == (0, 0)
    morph(bpy.context, {"Ball": {"Wide": 0.8}}, SETTINGS, others_yield=True)
    assert wide.value > alone + 0.1
    assert 0.1 < flat.value <= np.float32(0.8) and muted.value == 0
    assert check_scene(bpy.context).pairs == ()


def test_relative_keys_groups_negative_ranges_and_muted_keys_act_as_in_blender() -> None:
    ball = ball_and_wall()
    add_key(ball, "Base", scaled(1.2), value=1.0)
    wide = add_key(ball, "Wide", scaled(0.2), "Base", slider_min=-2.0)
    group = ball.vertex_groups.new(name="Right")
    group.add([k for k, v in enumerate(ball.data.vertices) if v.co.x > 0.5], 0.5, "REPLACE")
    wide.vertex_group = "Right"
    left = float(evaluated(ball)[:, 0].min())
    morph(bpy.context, {"Ball": {"Wide": -5.0}}, SETTINGS)
    assert -2 < wide.value < -1
    check_stopped(ball)
    assert float(evaluated(ball)[:, 0].min()) == left
    muted = add_key(ball, "Muted", scaled(50), mute=True)
    assert morph(bpy.context, {"Ball": {"Muted": 1.0}}, SETTINGS).status == "reached"
    assert muted.value == 1


def test_goals_beyond_the_range_end_at_it() -> None:
    ball = ball_and_wall(50.0)
    wide = add_key(ball, "Wide", scaled(3), slider_max=0.7)
    assert morph(bpy.context, {"Ball": {"Wide": 4.0}}, SETTINGS).status == "corrected"
    assert wide.value == np.float32(0.7)


@pytest.mark.parametrize("modifier", ["SUBSURF", "DISPLACE", "SOLIDIFY"])
def test_blender_evaluates_modifiers_after_the_keys(modifier: str) -> None:
    ball = ball_and_wall()
    add_key(ball, "Wide", scaled(3))
    added = ball.modifiers.new(modifier.title(), modifier)
    if modifier == "DISPLACE":
        added.strength = 0.2
    if modifier == "SOLIDIFY":
        added.thickness = 0.1
    morph(bpy.context, {"Ball": {"Wide": 1.0}}, SETTINGS)
    check_stopped(ball)


def test_objects_that_follow_the_shape_are_part_of_the_surface() -> None:
    """A child of a vertex of the ball reaches the wall before the ball does."""
    ball = ball_and_wall()
    wide = add_key(ball, "Wide", scaled(3))
    cube = add_cube("Cube", size=0.2)
    cube.parent, cube.parent_type = ball, "VERTEX"
    vertices = np.array([v.co for v in ball.data.vertices])
    cube.parent_vertices = [int(np.argmax(vertices[:, 0] - 0.01 * np.abs(vertices[:, 2])))] * 3
    cube.location = (0.25, 0, 0)
    bpy.context.view_layer.update()
    morph(bpy.context, {"Ball": {"Wide": 1.0}}, SETTINGS)
    assert 0.1 < wide.value < 0.4
    assert widest(cube) == pytest.approx(1.99, abs=0.02)
    assert check_scene(bpy.context).pairs == ()


def test_random_morphs_never_intersect() -> None:
    """Random keys of random sizes beside a wall and a cube: after each morph, the exact test finds nothing."""
    random = np.random.default_rng(3)
    ball = ball_and_wall(1.4)
    add_cube("Cube", (-0.3, 1.7, 0.1), 0.6)
    names = ["A", "B", "C"]
    for name in names:
        factors = random.uniform(0.3, 3, 3)
        shift = random.uniform(-0.5, 0.5, 3)
        add_key(ball, name, lambda co, f=factors, d=shift: np.array(co) * f + d, slider_min=-0.3)
    stopped = 0
    for _ in range(12):
        goals = dict(zip(names, random.uniform(-0.3, 1, 3).tolist(), strict=True))
        report = morph(bpy.context, {"Ball": goals}, SETTINGS, others_yield=bool(random.random() < 0.5))
        stopped += any(abs(report.values["Ball", name] - goal) > 0.01 for name, goal in goals.items())
        assert check_scene(bpy.context).pairs == ()
        for block in ball.data.shape_keys.key_blocks[1:]:
            assert block.slider_min <= block.value <= block.slider_max
    assert stopped > 2


def test_keyframes_are_inserted_with_auto_keying() -> None:
    ball = ball_and_wall()
    wide = add_key(ball, "Wide", scaled(3))
    bpy.context.scene.tool_settings.use_keyframe_insert_auto = True
    bpy.context.scene.frame_set(7)
    morph(bpy.context, {"Ball": {"Wide": 1.0}}, SETTINGS)
    value = wide.value
    bpy.context.scene.frame_set(8)
    assert ball.data.shape_keys.animation_data.action is not None
    assert wide.value == value


def driven(ball: Any) -> None:
    ball.data.shape_keys.key_blocks["Wide"].driver_add("value")


def absolute(ball: Any) -> None:
    ball.data.shape_keys.use_relative = False


def solo(ball: Any) -> None:
    ball.show_only_shape_key = True


@pytest.mark.parametrize(
    ("prepare", "values", "message"),
    [
        (driven, {"Ball": {"Wide": 1}}, "Ball: the value of Wide has a driver; remove it"),
        (absolute, {"Ball": {"Wide": 1}}, "Ball: its shape keys are absolute; turn on Relative"),
        (solo, {"Ball": {"Wide": 1}}, "Ball: it shows only its active shape key"),
        (None, {"Ball": {"Thin": 1}}, "Ball: it has no shape key Thin"),
        (None, {"Ball": {"Basis": 1}}, "Ball: Basis is the reference key"),
        (None, {"Ball": {"Wide": np.nan}}, "Ball: the value of Wide is not finite"),
        (None, {"Ball": {}}, "no shape key is given a value"),
        (None, {"Wall": {"Wide": 1}}, "Wall: it has no shape keys; add some"),
        (None, {"Gone": {"Wide": 1}}, "Gone: there is no such object"),
    ],
)
def test_what_cannot_be_moved_is_refused_by_name(
    prepare: Callable[[Any], None] | None, values: dict[str, dict[str, float]], message: str
) -> None:
    ball = ball_and_wall()
    wide = add_key(ball, "Wide", scaled(3), value=0.2)
    if prepare is not None:
        prepare(ball)
    before = wide.value
    with pytest.raises(stiv.InputError, match=message):
        morph(bpy.context, values, SETTINGS)
    assert wide.value == before


def test_a_start_that_intersects_another_object_is_refused_with_nothing_changed() -> None:
    ball = ball_and_wall(0.5)
    wide = add_key(ball, "Wide", scaled(3), value=0.2)
    before = wide.value
    with pytest.raises(stiv.StartIntersectsError):
        morph(bpy.context, {"Ball": {"Wide": 1.0}}, SETTINGS)
    assert wide.value == before


def test_an_object_that_intersects_itself_can_still_be_morphed() -> None:
    ball = ball_and_wall()
    add_key(ball, "Wide", scaled(3))
    ends = [(-0.5, 0, 0.2), (0.5, 0, 0.2), (0, 0, 0.9), (-0.4, -0.3, 0.5), (0.4, 0.4, 0.5), (0, 0.5, 0.4)]
    crossed = add("Crossed", mesh("Crossed", np.array(ends) + [-4, 0, 0], [(0, 1, 2), (3, 4, 5)]))
    add_key(crossed, "Up", lambda co: (co[0], co[1], co[2] + 1))
    morph(bpy.context, {"Ball": {"Wide": 1.0}}, SETTINGS)
    assert widest(ball) == pytest.approx(1.99, abs=0.02)
    assert morph(bpy.context, {"Crossed": {"Up": 1.0}}, SETTINGS).status == "reached"


def add_shirt(radius: float = 1.2) -> Any:
    """A tube around the ball."""
    bpy.ops.mesh.primitive_cylinder_add(radius=radius, depth=1.4, vertices=24, end_fill_type="NOTHING")
    shirt = bpy.context.object
    shirt.name = "Shirt"
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.subdivide(number_cuts=4)
    bpy.ops.object.mode_set(mode="OBJECT")
    return shirt


@pytest.mark.shared
@pytest.mark.parametrize("kind", ["vertices", "arap", "lattice"])
def test_clothes_yield_to_a_body_that_changes(kind: str) -> None:
    """With Yields: Others, the slider reaches its goal, and the shirt is wider by then."""
    ball = ball_and_wall(5.0)
    wide = add_key(ball, "Wide", scaled(1.6, 1.2))
    shirt = add_shirt()
    if kind == "arap":
        shirt.vertex_groups.new(name="Grip").add(list(range(0, len(shirt.data.vertices), 3)), 1.0, "REPLACE")
    if kind == "lattice":
        lattice = bpy.data.objects.new("Lattice", bpy.data.lattices.new("Lattice"))
        lattice.data.points_u = lattice.data.points_v = lattice.data.points_w = 4
        lattice.scale = (3, 3, 2)
        bpy.context.collection.objects.link(lattice)
        shirt.modifiers.new("Lattice", "LATTICE").object = lattice
    before = widest(shirt)
    alone = morph(bpy.context, {"Ball": {"Wide": 1.0}}, SETTINGS)
    assert alone.status in ("corrected", "blocked") and wide.value < 0.4 and widest(shirt) == before
    settings = EditSettings(
        separation=0.01,
        responders="unselected",
        deformations={"Shirt": kind},
        handles={"Shirt": Handles(groups=("Grip",))} if kind == "arap" else {},
    )
    morph(bpy.context, {"Ball": {"Wide": 1.0}}, settings)
    assert check_scene(bpy.context).pairs == ()
    assert wide.value == 1.0 and widest(shirt) > before + 0.2


def test_a_drag_of_a_body_under_clothes_restores_both() -> None:
    ball = ball_and_wall(1.7)
    wide = add_key(ball, "Wide", scaled(2.0))
    shirt = add_shirt()
    before = evaluated(shirt)
    settings = EditSettings(separation=0.01, responders="unselected", deformations={"Shirt": "vertices"})
    edit = MorphEdit.begin(bpy.context, {"Ball": {"Wide": 0.0}}, settings)
    for goal in np.linspace(0.1, 1.0, 10):
        edit.advance(np.array([goal]), 0.04)
        assert edit.show() == "" and edit.is_shown() and check_scene(bpy.context).pairs == ()
    edit.advance(np.array([1.0]))
    edit.show()
    assert 0.4 < wide.value < 0.72 and edit.has_moved_clothes  # the shirt is between the ball and the wall
    edit.restore()
    assert wide.value == 0 and np.array_equal(evaluated(shirt), before)


def test_loose_edges_that_cut_their_own_mesh_are_left_out_and_counted() -> None:
    sheet = add("Sheet", mesh("Sheet", [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [range(4)]))
    sheet.data.vertices.add(2)
    sheet.data.vertices[4].co, sheet.data.vertices[5].co = (0.4, 0.5, -0.5), (0.4, 0.5, 0.5)
    sheet.data.edges.add(1)
    sheet.data.edges[-1].vertices = (4, 5)
    add_key(sheet, "Wide", lambda co: (co[0] * 2, co[1], co[2]))
    report = morph(bpy.context, {"Sheet": {"Wide": 1.0}}, SETTINGS)
    note = "Sheet: 1 loose edge or vertex touches it and is not tested"
    assert (report.status, report.start_notes) == ("reached", (note,))


def test_seams_of_a_mesh_that_is_not_welded_stay_closed_or_are_named() -> None:
    """Faces beside a seam touch at the start. They are tested like neighbours unless a key moves the copies apart."""
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    sheet = add("Sheet", mesh("Sheet", [*corners, *((-x, y, z) for x, y, z in corners)], [range(4), range(7, 3, -1)]))
    add_key(sheet, "Wide", lambda co: (co[0] * 2, co[1], co[2]))
    report = morph(bpy.context, {"Sheet": {"Wide": 1.0}}, SETTINGS)
    assert (report.status, report.start_notes) == ("reached", ())
    for point in list(add_key(sheet, "Open", scaled()).data)[:4]:
        point.co.x += 0.5
    for key, notes in (("Wide", ()), ("Open", ("Sheet intersects itself, 2 faces, left as it is",))):
        report = morph(bpy.context, {"Sheet": {key: 0.5}}, SETTINGS)
        assert (report.status, report.start_notes) == ("reached", notes)
