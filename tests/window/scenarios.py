# SPDX-License-Identifier: GPL-3.0-or-later
"""What is tried in the window. Each scenario is a generator; a `yield` lets Blender work for a tick."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import bmesh
import bpy
import scenes
from scenes import HALF, WALL_FACE
from simulation import Steps, Window

FURTHEST = WALL_FACE - HALF  # of the box's centre
NEAR = 0.02  # how near to contact a drag has to come
INTO_WALL = (3.2, 0.0, 0.0)


def prepared(window: Window, build: object, active: str, mode: str = "OBJECT") -> Steps:
    """Build a scene with the wall, select, look from above, and begin the undo history with it."""
    with window.override():
        scenes.clear()
        build()
        scenes.add_wall()
        scenes.select_only(bpy.data.objects[active])
        scenes.look_from_above(window.area)
        if mode == "EDIT":
            bpy.ops.object.mode_set(mode="EDIT")
            select_right_half()
        bpy.ops.ed.undo_push(message="start")
    yield from window.settle()
    yield from window.rest_at((0.0, 0.0, 0.0))


def select_right_half() -> None:
    """In Edit Mode: what lies at x > 0."""
    data = bpy.context.object.data
    if bpy.context.object.type == "MESH":
        content = bmesh.from_edit_mesh(data)
        for vertex in content.verts:
            vertex.select_set(vertex.co.x > 0.1)
        content.select_flush_mode()
        bmesh.update_edit_mesh(data)
    else:
        for point in data.points:
            point.select = point.co_deform.x > 0.1  # `co` is nonsense in Edit Mode


def start(window: Window, key: str = "M") -> Steps:
    """Begin a transform by its key."""
    window.key(key, shift=True, alt=True)
    yield from window.until(window.dragging, "a running transform")


def click(window: Window, button: str = "LEFTMOUSE") -> Steps:
    """Press a button, and see the transform end."""
    window.key(button)
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    yield from window.settle()


def expect_free(window: Window) -> None:
    """The exact test on what Blender evaluates finds nothing."""
    with window.override():
        assert bpy.ops.stiv.check() == {"FINISHED"}
    found = bpy.context.window_manager.stiv_check.summary
    assert found.splitlines()[0] == "No intersections", found


def expect_near(value: float, expected: float, tolerance: float, what: str) -> None:
    """Compare with a message that says what was compared."""
    assert abs(value - expected) <= tolerance, f"{what}: {value!r}, expected {expected!r} within {tolerance!r}"


def box_x() -> float:
    """Where the box is; looked up at each use, since undo makes new objects."""
    return bpy.data.objects["Box"].location.x


def rigid_drag(window: Window) -> Steps:
    """A box against a wall: stops there, one undo step, redo gives the same bits."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    expect_near(box_x(), FURTHEST, NEAR, "the box at the wall while dragging")
    window.picture("rigid_drag")
    yield from click(window)
    confirmed = box_x()
    expect_near(confirmed, FURTHEST, NEAR, "the box at the wall")
    expect_free(window)
    yield from window.undo()
    assert box_x() == 0.0, box_x()
    yield from window.redo()
    assert box_x() == confirmed, box_x()


def rigid_return(window: Window) -> Steps:
    """The mouse comes back, and so does the box."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    yield from window.glide(window.pixel((0.5, 0.0, 0.0)))
    expect_near(box_x(), 0.5, 0.02, "the box under the mouse")
    yield from click(window)
    expect_free(window)


def cancelled_by(button: str) -> object:
    """A scenario: the button restores, bit by bit, and leaves no undo step."""

    def scenario(window: Window) -> Steps:
        yield from prepared(window, scenes.add_box, "Box")
        before = [tuple(row) for row in bpy.data.objects["Box"].matrix_world]
        yield from start(window)
        yield from window.glide(window.pixel(INTO_WALL))
        assert box_x() > 1.0, box_x()
        yield from click(window, button)
        assert [tuple(row) for row in bpy.data.objects["Box"].matrix_world] == before
        assert bpy.data.objects["Box"].location.length == 0.0

    scenario.__name__ = f"cancelled_by_{button.lower()}"
    return scenario


def typed_value(window: Window) -> Steps:
    """Digits, a decimal point, backspace and minus, then Enter."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.type("0.79")
    window.key("BACK_SPACE")
    yield
    window.key("RET")
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    expect_near(box_x(), 0.7, 1e-6, "the typed value")
    yield from start(window)
    yield from window.type("1-")
    window.key("RET")
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    expect_near(box_x(), -0.3, 1e-6, "the typed negative value")
    yield from window.undo()
    expect_near(box_x(), 0.7, 1e-6, "after undo")


def typed_into_wall(window: Window) -> Steps:
    """A typed value that goes through the wall ends in front of it."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.type("5")
    window.key("RET")
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    expect_near(box_x(), FURTHEST, NEAR, "the box at the wall")
    expect_free(window)


def axis_lock(window: Window) -> Steps:
    """X keeps the box on the axis, Shift+X keeps it off, three times lets go."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    window.key("X")
    yield from window.glide(window.pixel((0.8, 0.6, 0.0)))
    x, y, z = bpy.data.objects["Box"].location
    expect_near(x, 0.8, 0.02, "x along the axis")
    assert y == 0.0 and z == 0.0, (y, z)
    window.key("X", shift=True)
    yield from window.settle()
    x, y, z = bpy.data.objects["Box"].location
    expect_near(y, 0.6, 0.02, "y in the plane")
    expect_near(x, 0.0, 1e-5, "x across the plane")
    window.key("X", shift=True)
    yield from window.settle()
    window.key("X", shift=True)
    yield from window.settle()
    expect_near(box_x(), 0.8, 0.02, "x when free")
    yield from click(window)


def rotate_at_wall(window: Window) -> Steps:
    """A bar turned toward the wall."""
    yield from prepared(window, scenes.add_box, "Box")
    bpy.data.objects["Box"].scale.y = 4.0
    yield from window.settle()
    yield from start(window, "R")
    yield from window.type("30")
    window.key("RET")
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    expect_near(bpy.data.objects["Box"].rotation_euler.z, math.radians(30.0), 1e-5, "the angle")
    expect_free(window)


def scale_at_wall(window: Window) -> Steps:
    """A box scaled up until it would go through the wall."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window, "E")
    yield from window.type("6")
    window.key("RET")
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    assert bpy.data.objects["Box"].scale.x > 1.5, bpy.data.objects["Box"].scale
    expect_free(window)


def cage_in_edit_mode(window: Window) -> Steps:
    """Vertices of a cage pushed into the wall: the smooth surface flattens against it."""
    yield from prepared(window, scenes.add_cage, "Cage", "EDIT")
    before = scenes.evaluated_extent("Cage")
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    expect_near(scenes.evaluated_extent("Cage"), WALL_FACE, 0.1, "the surface at the wall while dragging")
    window.picture("cage_in_edit_mode")
    yield from click(window)
    assert bpy.context.mode == "EDIT_MESH"
    assert scenes.evaluated_extent("Cage") < WALL_FACE
    expect_free(window)
    yield from window.undo()
    expect_near(scenes.evaluated_extent("Cage"), before, 1e-6, "the surface after undo")
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    yield from click(window, "ESC")
    assert scenes.evaluated_extent("Cage") == before


def lattice_in_edit_mode(window: Window) -> Steps:
    """Points of a lattice pushed into the wall take the ball with them, up to the wall."""
    yield from prepared(window, scenes.add_ball_in_lattice, "Lattice", "EDIT")
    before = scenes.evaluated_extent("Ball")
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    expect_near(scenes.evaluated_extent("Ball"), WALL_FACE, 0.1, "the ball at the wall while dragging")
    window.picture("lattice_in_edit_mode")
    yield from click(window)
    assert bpy.context.mode == "EDIT_LATTICE"
    assert scenes.evaluated_extent("Ball") < WALL_FACE
    expect_free(window)
    yield from window.undo()
    assert scenes.evaluated_extent("Ball") == before
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    yield from click(window, "RIGHTMOUSE")
    assert scenes.evaluated_extent("Ball") == before


def lattice_in_object_mode(window: Window) -> Steps:
    """The lattice object moved as a whole, responding by its points."""
    yield from prepared(window, scenes.add_ball_in_lattice, "Lattice")
    bpy.context.scene.stiv.object_response = "deform"
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    expect_near(scenes.evaluated_extent("Ball"), WALL_FACE, 0.1, "the ball at the wall while dragging")
    yield from click(window)
    expect_free(window)


def object_deleted(window: Window) -> Steps:
    """The dragged object disappears: the drag ends by itself."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((0.5, 0.0, 0.0)))
    bpy.data.objects.remove(bpy.data.objects["Box"])
    window.move(*window.pixel((0.8, 0.0, 0.0)))
    yield from window.until(lambda: not window.dragging(), "the end of the transform")


def mode_changed(window: Window) -> Steps:
    """Edit Mode is left during the drag: it ends and the cage is as it was."""
    yield from prepared(window, scenes.add_cage, "Cage", "EDIT")
    before = scenes.evaluated_extent("Cage")
    yield from start(window)
    yield from window.glide(window.pixel((0.5, 0.0, 0.0)))
    with window.override():
        bpy.ops.object.mode_set(mode="OBJECT")
    window.move(*window.pixel((0.8, 0.0, 0.0)))
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    yield from window.settle()
    assert scenes.evaluated_extent("Cage") == before


def saved_during_drag(window: Window) -> Steps:
    """What is saved during a drag is the last accepted state."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    path = str(Path(tempfile.mkdtemp()) / "during drag.blend")
    with window.override():
        bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)
    yield from click(window, "ESC")
    with bpy.data.libraries.load(path) as (_, wanted):
        wanted.objects = ["Box"]
    expect_near(wanted.objects[0].location.x, FURTHEST, NEAR, "the box in the file")
    bpy.data.objects.remove(wanted.objects[0])


def keys_are_free(window: Window) -> Steps:
    """No key of the extension is taken in Blender's default keymap of these modes and their windows."""
    configurations = bpy.context.window_manager.keyconfigs
    ours = [item for keymap in configurations.addon.keymaps for item in keymap.keymap_items if "stiv" in item.idname]
    assert len(ours) == 12, [item.idname for item in ours]
    around = {"Window", "Screen", "Screen Editing", "Frames", "3D View", "3D View Generic", "Object Non-modal"}
    taken = {
        (item.type, item.shift, item.ctrl, item.alt)
        for keymap in configurations.default.keymaps
        if not keymap.is_modal and keymap.name in {"Object Mode", "Mesh", "Lattice", *around}
        for item in keymap.keymap_items
    }
    clashes = [item.idname for item in ours if (item.type, item.shift, item.ctrl, item.alt) in taken]
    assert not clashes, clashes
    yield


_ALL = (
    keys_are_free,
    rigid_drag,
    rigid_return,
    cancelled_by("ESC"),
    cancelled_by("RIGHTMOUSE"),
    typed_value,
    typed_into_wall,
    axis_lock,
    rotate_at_wall,
    scale_at_wall,
    cage_in_edit_mode,
    lattice_in_edit_mode,
    lattice_in_object_mode,
    saved_during_drag,
    mode_changed,
    object_deleted,
)
SCENARIOS = {scenario.__name__: scenario for scenario in _ALL}
