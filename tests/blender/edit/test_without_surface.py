# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects without a mesh: hair, point clouds and volumes beside edited objects."""

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, evaluated, select, shift, snapshot, stretch, turn

from stiv import InputError
from stiv.blender import BlenderEdit, EditSettings, Motion

DATA = {
    "hair": lambda: bpy.data.hair_curves.new("Other"),
    "points": lambda: bpy.data.pointclouds.new("Other"),
    "volume": lambda: bpy.data.volumes.new("Other"),
    "curve": lambda: bpy.data.curves.new("Other", "CURVE"),
}


@pytest.mark.parametrize("kind", DATA)
@pytest.mark.parametrize("responders", ["selected", "unselected", "all"])
def test_edits_work_beside_objects_without_a_surface(kind: str, responders: str) -> None:
    add_grid("Floor", 2, 3.0)
    cube, other = add_cube("Cube", (0, 0, 1.5)), add("Other", DATA[kind](), (9, 0, 0))
    select(cube)
    edit = BlenderEdit.begin(bpy.context, EditSettings(responders=responders), "move")
    edit.apply(shift(x=1))
    assert edit.write().passed
    assert cube.location.x == pytest.approx(1) and other.location.x == 9


OTHERS = {
    "camera": lambda: bpy.data.cameras.new("Other"),
    "armature": lambda: bpy.data.armatures.new("Other"),
    "empty": lambda: None,
    "pencil": lambda: getattr(bpy.data, "grease_pencils_v3", bpy.data.grease_pencils).new("Other"),
}


@pytest.mark.parametrize("kind", DATA | OTHERS)
def test_selected_objects_without_a_surface_move_along(kind: str) -> None:
    add_grid("Floor", 2, 3.0)
    other, cube = add("Other", (DATA | OTHERS)[kind](), (9, 0, 5)), add_cube("Cube", (0, 0, 1.5))
    select(cube, other)
    start = snapshot()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.apply(shift(z=-2))
    assert edit.write().passed and edit.start_notes == ()
    assert 1 < cube.location.z < 1.01
    assert other.location.z == pytest.approx(5 + cube.location.z - 1.5, abs=1e-6)
    edit.restore()
    assert snapshot() == start


@pytest.mark.parametrize("kind", ["rotate", "scale"])
def test_they_turn_and_scale_along_about_the_pivot(kind: str) -> None:
    cube, camera = add_cube("Cube"), add("Camera", bpy.data.cameras.new("Camera"), (4, 0, 0))
    select(cube, camera)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), kind)
    assert edit.apply(turn(0.5, "Z") if kind == "rotate" else stretch(1.5)).status == "reached" and edit.write().passed
    expected = (4 * np.cos(0.5), 4 * np.sin(0.5), 0) if kind == "rotate" else (6, 0, 0)
    np.testing.assert_allclose(camera.location, expected, atol=1e-6)
    assert camera.rotation_euler.z == pytest.approx(0.5 if kind == "rotate" else 0, abs=1e-6)
    assert camera.scale.x == pytest.approx(1.5 if kind == "scale" else 1)


def locked(ob: Any) -> None:
    ob.lock_location = (True, False, False)


def constrained(ob: Any) -> None:
    ob.constraints.new("TRACK_TO").target = bpy.data.objects["Cube"]


def turned(ob: Any) -> None:
    ob.rotation_euler = (0.3, 0.2, 0.1)


@pytest.mark.parametrize(("hold", "kind"), [(locked, "move"), (constrained, "move"), (turned, "scale")])
def test_those_that_cannot_move_along_freely_stay_and_are_named(hold: Callable[[Any], None], kind: str) -> None:
    """They must not keep the others from moving."""
    cube, camera = add_cube("Cube"), add("Camera", bpy.data.cameras.new("Camera"), (4, 0, 0))
    hold(camera)
    select(cube, camera)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), kind)
    assert edit.start_notes == (edit.passenger_note,) == ("Camera: cannot move along; use Blender's own transform",)
    assert edit.apply(shift(x=1) if kind == "move" else stretch(2.0)).status == "reached" and edit.write().passed
    assert tuple(camera.location) == (4, 0, 0) and tuple(camera.scale) == (1, 1, 1)


def test_a_locked_camera_stays_as_in_blender() -> None:
    cube, camera = add_cube("Cube"), add("Camera", bpy.data.cameras.new("Camera"), (4, 0, 0))
    camera.lock_location = (True, True, True)
    select(cube, camera)
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    assert edit.apply(shift(x=1)).status == "reached" and edit.write().passed and edit.start_notes == ()
    assert cube.location.x == 1 and camera.location.x == 4


@pytest.mark.parametrize(
    ("data", "response"),
    [((DATA | OTHERS)[kind], response) for kind in DATA | OTHERS for response in ("rigid", "deform")]
    + [(lambda: bpy.data.meshes.new("Other"), "deform")],
)
def test_a_selection_without_a_surface_is_refused_by_name(data: Callable[[], Any], response: str) -> None:
    """A mesh without vertices once ended in "cannot reshape array of size 0 into shape (0,newaxis)"."""
    add_cube("Cube")
    select(add("Other", data(), (9, 0, 0)))
    with pytest.raises(InputError, match=r"^Other: (has )?no surface") as raised:
        BlenderEdit.begin(bpy.context, EditSettings(object_response=response), "move")
    assert len(str(raised.value)) <= 80


def test_a_mesh_that_shows_only_points_is_refused_by_name() -> None:
    """It once ended in "zip() argument 2 is longer than argument 1"."""
    tree = bpy.data.node_groups.new("Points", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    first, points, last = (
        tree.nodes.new(kind) for kind in ("NodeGroupInput", "GeometryNodeMeshToPoints", "NodeGroupOutput")
    )
    tree.links.new(first.outputs[0], points.inputs[0])
    tree.links.new(points.outputs[0], last.inputs[0])
    cube = add_cube("Cube")
    cube.modifiers.new("Nodes", "NODES").node_group = tree
    select(cube)
    with pytest.raises(InputError, match='Cube: Geometry Nodes "Nodes" shows no surface; disable it'):
        BlenderEdit.begin(bpy.context, EditSettings(object_response="deform"), "move")


def deform(**given: Any) -> EditSettings:
    return EditSettings(object_response="deform", **given)


def test_they_move_along_where_everything_deforms() -> None:
    """The cube stops at the floor and flattens; the camera goes where Blender would put it."""
    add_grid("Floor", 2, 3.0)
    cube, camera = add_cube("Cube", (0, 0, 1.5)), add("Camera", bpy.data.cameras.new("Camera"), (4, 0, 5))
    select(cube, camera)
    start = snapshot()
    edit = BlenderEdit.begin(bpy.context, deform(), "move")
    assert edit.apply(shift(z=-1)).status == "corrected" and edit.write().passed and edit.start_notes == ()
    assert tuple(camera.location) == (4, 0, 4) and evaluated(cube)[:, 2].min() > 0
    edit.drag(shift(x=1, z=-1))
    taken = edit.take_state()
    assert taken is not None and edit.write_taken(taken) is not None
    assert tuple(camera.location) == (5, 0, 4) and edit.moving == {"Cube"}
    edit.restore()
    assert snapshot() == start


@pytest.mark.parametrize("individual", [False, True])
@pytest.mark.parametrize("kind", ["rotate", "scale"])
@pytest.mark.parametrize("response", ["rigid", "deform"])
def test_they_turn_and_scale_as_in_blender(kind: str, individual: bool, response: str) -> None:
    """With individual origins, each of them about its own."""
    cube, camera = add_cube("Cube"), add("Camera", bpy.data.cameras.new("Camera"), (4, 0, 0))
    select(cube, camera)
    edit = BlenderEdit.begin(bpy.context, EditSettings(object_response=response), kind)
    motion = Motion(turn(0.5, "Z") if kind == "rotate" else stretch(1.5), np.zeros(3), individual=individual)
    assert edit.apply(motion).status == "reached" and edit.write().passed
    about_pivot = (4 * np.cos(0.5), 4 * np.sin(0.5), 0) if kind == "rotate" else (6, 0, 0)
    np.testing.assert_allclose(camera.location, (4, 0, 0) if individual else about_pivot, atol=1e-6)
    assert camera.rotation_euler.z == pytest.approx(0.5 if kind == "rotate" else 0, abs=1e-6)
    assert camera.scale.x == pytest.approx(1.5 if kind == "scale" else 1)


def test_a_turned_camera_scales_along_with_what_deforms() -> None:
    cube, camera = add_cube("Cube"), add("Camera", bpy.data.cameras.new("Camera"), (4, 0, 0))
    turned(camera)
    select(cube, camera)
    edit = BlenderEdit.begin(bpy.context, deform(), "scale")
    assert edit.apply(stretch(2.0)).status == "reached" and edit.write().passed and edit.passenger_note == ""
    assert tuple(camera.location) == (8, 0, 0) and tuple(camera.scale) == pytest.approx((2, 2, 2))


def test_those_that_cannot_are_named_also_where_everything_deforms() -> None:
    cube, camera = add_cube("Cube"), add("Camera", bpy.data.cameras.new("Camera"), (4, 0, 0))
    constrained(camera)
    select(cube, camera)
    edit = BlenderEdit.begin(bpy.context, deform(), "move")
    assert edit.start_notes == (edit.passenger_note,) == ("Camera: cannot move along; use Blender's own transform",)
    assert edit.apply(shift(x=1)).status == "reached" and edit.write().passed and camera.location.x == 4
