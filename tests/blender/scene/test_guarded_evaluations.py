# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit Mode, Object Mode and the render after edits, tested by rational arithmetic outside the package."""

import random
from itertools import pairwise
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_modifier, as_rendered, edit_mode, meet, select, snapshot

from stiv.blender import BlenderEdit, EditSettings, check_scene
from stiv.command_line.repair import repair_file
from stiv.command_line.repair_report import RepairChoices

pytestmark = pytest.mark.usefixtures("registered")


def counts() -> dict[str, int]:
    names = ("objects", "meshes", "scenes", "collections", "curves", "shape_keys", "node_groups", "worlds")
    return {name: len(getattr(bpy.data, name)) for name in names}


def meetings(name: str = "Cube", other: str = "Wall") -> list[int]:
    """In the mode that it is in, in Object Mode, rendered; the file is left showing what it renders."""
    bpy.context.view_layer.update()
    found = [meet(name, other)] if bpy.data.objects[other].visible_get() else [0]
    bpy.ops.object.mode_set(mode="OBJECT")
    found += [meet(name, other)] if bpy.data.objects[other].visible_get() else [0]
    as_rendered()
    return [*found, 0 if bpy.data.objects[other].hide_render else meet(name, other)]


def add_wall(**properties: Any) -> Any:
    return add_grid("Wall", 4, 4.0, (3, 0, 0), rotation_euler=(0, np.pi / 2, 0.2), **properties)


def move(**values: Any) -> str:
    """The error of the operator, or ""."""
    bpy.context.scene.tool_settings.use_proportional_edit = False
    try:
        bpy.ops.stiv.move(value=(4, 0, 0), **values)
    except RuntimeError as error:
        return str(error).removeprefix("Error: ").strip()
    return ""


def test_modifiers_shown_only_in_object_mode_are_followed_in_edit_mode() -> None:
    add_wall()
    cube = add_cube("Cube")
    add_modifier(cube, "DISPLACE", strength=1.0, mid_level=0.0)
    edit_mode(cube)
    before, kept = snapshot(), counts()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert 'Cube: also follows "Displace", hidden in Edit Mode' in edit.start_notes
    assert move() == ""
    assert snapshot() != before and counts() == kept
    assert meetings() == [0, 0, 0]


def test_a_posed_armature_is_followed_in_edit_mode() -> None:
    add_wall()
    arm = add("Arm", bpy.data.armatures.new("Arm"))
    edit_mode(arm)
    bone = arm.data.edit_bones.new("Bone")
    bone.tail = (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    arm.pose.bones["Bone"].location = (0.9, 0, 0)
    cube = add_cube("Cube")
    cube.vertex_groups.new(name="Bone").add(range(8), 1.0, "REPLACE")
    add_modifier(cube, "ARMATURE", "Armature", object=arm)
    edit_mode(cube)
    before = snapshot()
    assert move() == ""
    assert snapshot() != before and meetings() == [0, 0, 0]


@pytest.mark.parametrize("response", ["slide_and_turn", "deform"])
def test_render_levels_are_guarded(response: str) -> None:
    add_wall()
    cube = add_cube("Cube")
    add_modifier(cube, "SUBSURF", levels=1, render_levels=3)
    select(cube)
    kept = counts()
    bpy.context.scene.stiv.object_response = response
    assert move() == ""
    assert counts() == kept
    assert meetings() == [0, 0, 0]


def test_guard_of_the_viewport_leaves_the_render_alone() -> None:
    add_wall()
    cube = add_cube("Cube")
    add_modifier(cube, "SUBSURF", levels=0, render_levels=2)
    add_modifier(cube, "DISPLACE", strength=0.5, mid_level=0.0, show_viewport=False)
    select(cube)
    bpy.context.scene.stiv.guard = "viewport"
    assert move() == ""
    found = meetings()
    assert found[:2] == [0, 0] and found[2] > 0
    assert check_scene(bpy.context, EditSettings(guard="render")).pairs


def test_objects_that_are_only_rendered_are_obstacles() -> None:
    add_wall().hide_viewport = True
    cube = add_cube("Cube")
    select(cube)
    bpy.context.scene.stiv.guard = "both"
    assert move() == ""
    assert cube.location.x < 2.5 and meetings() == [0, 0, 0]


@pytest.mark.parametrize("guard", ["viewport", "render", "both"])
def test_objects_outside_local_view_are_obstacles_to_the_render_only(guard: str) -> None:
    add_wall()
    cube = add_cube("Cube")
    select(cube)
    bpy.context.scene.stiv.guard = guard
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.view3d.localview(frame_selected=False)
        try:
            assert move() == ""
        finally:
            bpy.ops.view3d.localview(frame_selected=False)
    if guard == "viewport":
        assert cube.location.x == 4.0
    else:
        assert cube.location.x < 2.5 and meetings() == [0, 0, 0]


def test_objects_that_are_not_rendered_are_ignored_in_the_render() -> None:
    add_wall().hide_render = True
    cube = add_cube("Cube")
    select(cube)
    bpy.context.scene.stiv.guard = "render"
    assert move() == ""
    assert cube.location.x == pytest.approx(4)


def test_a_large_render_is_left_out_with_a_message() -> None:
    add_wall()
    cube = add_cube("Cube")
    add_modifier(cube, "SUBSURF", levels=1, render_levels=9)
    found = check_scene(bpy.context)
    assert found.guard == "viewport" and "500,000 triangles" in found.reason
    cube.modifiers[0].render_levels = 2
    assert check_scene(bpy.context).guard == "both"
    cube.modifiers[0].render_levels = 1
    assert check_scene(bpy.context).guard == "viewport" and not check_scene(bpy.context).reason


def test_cancelled_and_failed_edits_leave_nothing_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    add_wall()
    cube = add_cube("Cube")
    add_modifier(cube, "SUBSURF", levels=1, render_levels=2, show_in_editmode=False)
    edit_mode(cube)
    before, kept = snapshot(), counts()

    def fail(*_unused: Any) -> None:
        raise RuntimeError("broken")

    monkeypatch.setattr("stiv.blender.verify.verification._merged", fail)
    assert "Unexpected error" in move()
    assert snapshot() == before and counts() == kept


SWITCHES = ("show_in_editmode", "show_viewport", "show_render")


def random_stack(choose: random.Random, ob: Any) -> None:
    kinds = [
        ("SUBSURF", {}),
        ("DISPLACE", {"strength": choose.choice((0.2, 0.8)), "mid_level": 0.0}),
        ("SOLIDIFY", {"thickness": 0.3, "offset": 1.0}),
        ("MIRROR", {"use_axis": (False, True, False)}),
    ]
    for kind, values in choose.sample(kinds, choose.choice((1, 1, 2))):
        modifier = add_modifier(ob, kind, **values)
        for switch in SWITCHES:
            setattr(modifier, switch, choose.random() < 0.7)
        if kind == "SUBSURF":
            modifier.levels, modifier.render_levels = choose.choice([(0, 2), (1, 2), (1, 3), (2, 1), (2, 2)])


@pytest.mark.shared
@pytest.mark.parametrize("seed", range(24))
def test_random_stacks_modes_and_levels(seed: int) -> None:
    choose = random.Random(seed)
    add_wall()
    cube = add_cube("Cube", size=0.6)
    random_stack(choose, cube)
    mode = edit_mode if choose.random() < 0.5 else select
    mode(cube)
    bpy.context.scene.stiv.object_response = choose.choice(("slide", "deform"))
    kept, before = counts(), snapshot()
    error = move()
    assert counts() == kept
    if error:
        assert snapshot() == before and "Cube" in error
    assert meetings() == [0, 0, 0], (seed, error)


def test_evaluations_of_an_object_do_not_collide() -> None:
    """Meshes of one object in several evaluations lie in each other."""
    cubes = [add_cube(name, (x, 0, 0)) for name, x in (("Cube", 0), ("Wall", 2.2))]
    for cube in cubes:
        add_modifier(cube, "SUBSURF", levels=0, render_levels=2, show_in_editmode=False)
    edit_mode(*cubes)
    for first, second in pairwise(cubes):
        first.data.update()
        second.data.update()
    assert move() == ""
    assert meetings() == [0, 0, 0]


def test_commands_take_the_guard(tmp_path: Path) -> None:
    add_grid("Wall", 2, 2.0, (1.2, 0, 0), rotation_euler=(0, np.pi / 2, 0))
    cube = add_cube("Cube")
    add_modifier(cube, "DISPLACE", strength=0.5, mid_level=0.0, show_viewport=False)
    scene = tmp_path / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(scene))
    repaired = repair_file(scene, tmp_path / "free.blend", RepairChoices(guard="viewport"))
    assert repaired["status"] == "already_free"
    repaired = repair_file(scene, tmp_path / "both.blend", RepairChoices(guard="both"))
    assert repaired["status"] == "repaired"


def test_the_summary_says_what_is_guarded() -> None:
    cube = add_cube("Cube")
    subdivision = add_modifier(cube, "SUBSURF", levels=1, render_levels=2)
    select(cube)
    assert BlenderEdit.begin(bpy.context, EditSettings(), "move").summary.guard == "both"
    subdivision.render_levels = 1
    assert BlenderEdit.begin(bpy.context, EditSettings(), "move").summary.guard == "viewport"


def test_undo_in_edit_mode_finds_no_copies() -> None:
    """A script's edit may add a step that stores the whole file, and is equal to the one before."""
    add_wall()
    cube = add_cube("Cube")
    add_modifier(cube, "SUBSURF", levels=1, render_levels=2, show_in_editmode=False)
    select(cube)
    bpy.ops.ed.undo_push(message="start")
    bpy.ops.object.mode_set("EXEC_DEFAULT", True, mode="EDIT")
    bpy.ops.mesh.select_all("EXEC_DEFAULT", True, action="SELECT")
    kept, states = counts(), [snapshot()]
    for x in (0.5, 0.25):
        bpy.ops.stiv.move("EXEC_DEFAULT", True, value=(x, 0, 0))
        states.append(snapshot())
    for step, state in ((bpy.ops.ed.undo, 1), (bpy.ops.ed.undo, 0), (bpy.ops.ed.redo, 1), (bpy.ops.ed.redo, 2)):
        before = snapshot()
        step()
        if snapshot() == before:
            step()
        assert snapshot() == states[state] and counts() == kept


def test_a_start_that_intersects_only_when_rendered_names_the_way_out() -> None:
    add_grid("Wall", 2, 2.0, (0.9, 0, 0), rotation_euler=(0, np.pi / 2, 0))
    cube = add_cube("Cube")
    add_modifier(cube, "SUBSURF", levels=2, render_levels=0)
    select(cube)
    before = snapshot()
    bpy.context.scene.stiv.separation = 0.001
    assert "only the render intersects; set Guard to Viewport" in move()
    assert snapshot() == before
    bpy.context.scene.stiv.guard = "viewport"
    assert move() == ""
