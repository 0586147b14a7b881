# SPDX-License-Identifier: GPL-3.0-or-later
"""The grammar of a drag, gesture by gesture, in the window."""

from __future__ import annotations

import math

import bmesh
import bpy
import scenes
from scenarios import FURTHEST, INTO_WALL, NEAR, box_x, click, expect_free, expect_near, prepared, start
from simulation import Steps, Window

CLOSE = 0.02  # about a pixel of the view


def box() -> bpy.types.Object:
    """The box; looked up at each use, since undo makes new objects."""
    return bpy.data.objects["Box"]


def ended(window: Window) -> Steps:
    """Wait for the end of a drag."""
    yield from window.until(lambda: not window.dragging(), "the end of the transform")
    yield from window.settle()


def kinds_switch(window: Window) -> Steps:
    """G, R and S within one drag go on from the start; one undo takes it back, under the name of the last kind."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((0.3, 0.8, 0.0)))
    expect_near(box().location.y, 0.8, CLOSE, "moved")
    window.key("R")
    yield from window.settle()
    assert box().location.length < 1e-6, box().location
    yield from window.glide(window.pixel((-0.8, 0.3, 0.0)))
    turned = box().rotation_euler.z
    assert abs(turned) > 0.3, turned
    window.picture("kinds_switch")
    window.key("S")
    yield from window.settle()
    assert box().rotation_euler.z == 0.0 and box().scale.x > 1.0, (box().rotation_euler, box().scale)
    window.key("R")
    yield from window.settle()
    yield from click(window)
    expect_near(box().rotation_euler.z, turned, 1e-4, "turned as before")
    assert bpy.context.window_manager.operators[-1].bl_idname == "STIV_OT_rotate"
    expect_free(window)
    yield from window.undo()
    assert box().rotation_euler.z == 0.0 and box().location.length == 0.0
    yield from window.redo()
    expect_near(box().rotation_euler.z, turned, 1e-4, "after redo")


def typed_components(window: Window) -> Steps:
    """Numbers in all components, Tab between them."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.type("0.5\t0.25-\t2")
    window.key("RET")
    yield from ended(window)
    found = tuple(round(coordinate, 6) for coordinate in box().location)
    assert found == (0.5, -0.25, 2.0), found


def typed_expression(window: Window) -> Steps:
    """An expression with units; what is no number cannot be confirmed."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.type("=50cm + 2*")
    window.key("RET")
    yield from window.settle()
    assert window.dragging(), "an unfinished expression was confirmed"
    yield from window.type("0.1m")
    window.key("RET")
    yield from ended(window)
    expect_near(box_x(), 0.7, 1e-6, "the value of the expression")


def local_axes(window: Window) -> Steps:
    """The same axis key again takes the object's own axes."""
    yield from prepared(window, scenes.add_box, "Box")
    box().rotation_euler.z = math.radians(30.0)
    yield from window.settle()
    yield from start(window)
    for _ in range(2):
        window.key("Y")
        yield
    yield from window.type("1")
    window.key("RET")
    yield from ended(window)
    expect_near(box().location.x, -0.5, 1e-5, "x along the local axis")
    expect_near(box().location.y, math.sqrt(0.75), 1e-5, "y along the local axis")


def precision(window: Window) -> Steps:
    """Shift held: a tenth of the way of the mouse."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((1.0, 0.0, 0.0)), shift=True)
    expect_near(box_x(), 0.1, 0.01, "a tenth of the way")
    yield from click(window)


def snap_to_steps(window: Window) -> Steps:
    """Ctrl held: whole steps; a turn by steps of five degrees."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((0.83, 0.27, 0.0)), ctrl=True)
    steps = [coordinate * 10.0 for coordinate in box().location]
    assert all(abs(step - round(step)) < 1e-3 for step in steps) and box_x() > 0.5, steps
    window.key("R")
    yield from window.glide(window.pixel((0.3, 0.9, 0.0)), ctrl=True)
    degrees = math.degrees(box().rotation_euler.z) / 5.0
    assert abs(degrees - round(degrees)) < 1e-3 and round(degrees), degrees
    yield from click(window, "ESC")


def snap_to_vertex(window: Window) -> Steps:
    """The nearest corner of the box goes to the block's corner: as near as it may, since both keep their distance."""
    yield from prepared(window, scenes.add_target, "Box")
    tools = bpy.context.scene.tool_settings
    tools.snap_elements, tools.use_snap = {"VERTEX"}, True
    yield from window.rest_at((-0.5, 0.5, 0.0))  # so that this corner is the nearest one
    yield from start(window)
    yield from window.glide(window.pixel((-1.02, 1.02, 0.25)))
    window.picture("snap_to_vertex")
    expect_near(box_x(), -0.5, NEAR, "x of the box with its corner on the block's")
    expect_near(box().location.y, 0.5, NEAR, "y of the box with its corner on the block's")
    yield from click(window)
    expect_free(window)


def snap_to_face(window: Window) -> Steps:
    """The lower side of the box is to lie on the block's upper face, and stops before it."""
    yield from prepared(window, scenes.add_target, "Box")
    tools = bpy.context.scene.tool_settings
    tools.snap_elements, tools.use_snap = {"FACE"}, True
    box().location.z = 2.0
    yield from window.settle()
    yield from start(window)
    yield from window.glide(window.pixel((-1.25, 1.25, 0.25)), steps=12)
    expect_near(box().location.z, 0.75, NEAR, "the box on the block")
    yield from click(window)
    assert box().location.z > 0.75
    expect_free(window)


def pivot_at_cursor(window: Window) -> Steps:
    """The 3D cursor as pivot."""
    yield from prepared(window, scenes.add_box, "Box")
    scene = bpy.context.scene
    scene.tool_settings.transform_pivot_point, scene.cursor.location = "CURSOR", (-1.0, 0.0, 0.0)
    yield from start(window, "R")
    yield from window.type("90")
    window.key("RET")
    yield from ended(window)
    expect_near(box_x(), -1.0, 1e-5, "x after a quarter turn about the cursor")
    expect_near(box().location.y, 1.0, 1e-5, "y after a quarter turn about the cursor")


def individual_origins(window: Window) -> Steps:
    """Each object turns about its own origin."""
    yield from prepared(window, scenes.add_pair, "Upper")
    bpy.context.scene.tool_settings.transform_pivot_point = "INDIVIDUAL_ORIGINS"
    bpy.data.objects["Lower"].select_set(True)
    yield from start(window, "R")
    yield from window.type("30")
    window.key("RET")
    yield from ended(window)
    for name, y in (("Upper", 1.0), ("Lower", -1.0)):
        thing = bpy.data.objects[name]
        expect_near(thing.location.y, y, 1e-6, f"y of {name}")
        expect_near(thing.rotation_euler.z, math.radians(30.0), 1e-5, f"turn of {name}")


def strip_y(at_x: float) -> float:
    """How far the strip is moved along y at x."""
    content = bmesh.from_edit_mesh(bpy.data.objects["Strip"].data)
    return max(vertex.co.y for vertex in content.verts if abs(vertex.co.x - at_x) < 0.05) - 0.2


def proportional(window: Window) -> Steps:
    """O lets neighbours follow, the wheel and the page keys say how far, Shift+O how."""
    yield from prepared(window, scenes.add_strip, "Strip", "EDIT")
    content = bmesh.from_edit_mesh(bpy.context.object.data)
    for vertex in content.verts:
        vertex.select_set(vertex.co.x > 1.1)
    content.select_flush_mode()
    bmesh.update_edit_mesh(bpy.context.object.data)
    yield from start(window)
    window.key("Y")
    yield from window.glide(window.pixel((0.0, 0.5, 0.0)))
    expect_near(strip_y(1.2), 0.5, CLOSE, "the end of the strip")
    expect_near(strip_y(0.6), 0.0, 1e-6, "a neighbour without proportional editing")
    window.key("O")
    yield from window.settle()
    before = strip_y(0.6)
    assert 0.05 < before < 0.45, before
    window.picture("proportional")
    for _ in range(4):
        window.key("WHEELDOWNMOUSE")
        yield
    window.key("PAGE_UP")
    yield from window.settle()
    larger = strip_y(0.6)
    assert larger > before + 0.05, (before, larger)
    for _ in range(6):
        window.key("O", shift=True)  # smooth, ... constant
        yield
    yield from window.settle()
    expect_near(strip_y(0.6), strip_y(1.2), 1e-5, "a neighbour with the constant falloff")
    yield from click(window)
    expect_near(strip_y(0.6), 0.5, CLOSE, "a neighbour after confirming")
    expect_free(window)
    yield from window.undo()
    expect_near(max(abs(strip_y(0.6)), abs(strip_y(1.2))), 0.0, 1e-6, "the strip after undo")


def proportional_lattice(window: Window) -> Steps:
    """Points of a lattice follow those selected; the ball in it stops at the wall."""
    yield from prepared(window, scenes.add_ball_in_lattice, "Lattice", "EDIT")
    bpy.context.scene.tool_settings.use_proportional_edit = True
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    expect_near(scenes.evaluated_extent("Ball"), scenes.WALL_FACE, 0.1, "the ball at the wall")
    yield from click(window)
    expect_free(window)


def view_navigation(window: Window) -> Steps:
    """The wheel zooms and the middle button turns the view during a drag, which goes on with the mouse."""
    yield from prepared(window, scenes.add_box, "Box")
    view = window.area.spaces.active.region_3d
    yield from start(window)
    yield from window.glide(window.pixel((0.5, 0.5, 0.0)))
    distance = view.view_distance
    for _ in range(3):
        window.key("WHEELUPMOUSE")
        yield
    yield from window.settle()
    assert view.view_distance < distance, "the wheel did not zoom"
    yield from window.glide(window.pixel((0.6, 0.4, 0.0)))
    expect_near(box_x(), 0.6, CLOSE, "the box under the mouse in the zoomed view")
    window.event("MIDDLEMOUSE", "PRESS")
    yield
    before = view.view_rotation.copy()
    yield from window.glide((window.mouse[0] + 60, window.mouse[1] + 30), 4)
    window.event("MIDDLEMOUSE", "RELEASE")
    yield from window.settle()
    assert view.view_rotation != before, "the middle button did not turn the view"
    assert window.dragging()
    yield from window.glide((window.mouse[0] + 40, window.mouse[1]), 4)
    window.picture("view_navigation")
    yield from click(window)
    assert box().location.length > 0.1
    expect_free(window)


def redo_panel(window: Window) -> Steps:
    """What the redo panel recomputes is what the drag came to, to the last bit, around the end of the wall too."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    for place in ((0.0, 2.8, 0.0), (2.9, 2.8, 0.0), (2.9, 0.4, 0.0)):
        yield from window.glide(window.pixel(place))
    yield from click(window)
    dragged = tuple(box().location)
    assert dragged[0] > 2.5 and dragged[1] < 1.0, dragged
    operator = bpy.context.window_manager.operators[-1]
    assert operator.bl_idname == "STIV_OT_move" and operator.outcome > 0
    with window.override():
        bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)  # what a change in the panel does
    yield from window.settle()
    assert tuple(box().location) == dragged, (tuple(box().location), dragged)
    expect_free(window)
    yield from window.undo()
    assert box().location.length == 0.0


def repeat_last(window: Window) -> Steps:
    """Shift+R applies the same value again, from where things are now."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.type("0.5")
    window.key("RET")
    yield from ended(window)
    window.key("R", shift=True)
    yield from window.settle()
    expect_near(box_x(), 1.0, 1e-5, "moved twice")
    window.key("R", shift=True)
    yield from window.settle()
    expect_near(box_x(), FURTHEST, NEAR, "at the wall")
    expect_free(window)


def interference_switched(window: Window) -> Steps:
    """I lets the box go through the wall, and I again takes it back to where it was free."""
    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((1.0, 0.0, 0.0)))
    window.key("I")
    yield from window.glide(window.pixel((1.8, 0.0, 0.0)))
    expect_near(box_x(), 1.8, CLOSE, "the box within the wall")
    window.key("I")
    yield from window.settle()
    assert box_x() < FURTHEST, box_x()
    yield from click(window)
    expect_free(window)


def others_give_way(window: Window) -> Steps:
    """W: the wall, which may move, gives way instead of the box."""
    yield from prepared(window, scenes.add_box, "Box")
    bpy.data.objects["Wall"].stiv.role = "rigid"
    yield from start(window)
    window.key("W")
    yield from window.glide(window.pixel((1.8, 0.0, 0.0)), steps=16)
    expect_near(box_x(), 1.8, CLOSE, "the box where it was put")
    assert bpy.data.objects["Wall"].location.x > 2.2, bpy.data.objects["Wall"].location
    yield from click(window)
    expect_free(window)


def fault_within(window: Window) -> Steps:
    """An exception in the middle of a drag: everything is put back, nothing stays behind."""
    from stiv.blender import BlenderEdit

    yield from prepared(window, scenes.add_box, "Box")
    yield from start(window)
    yield from window.glide(window.pixel((0.5, 0.0, 0.0)))
    original = BlenderEdit.drag

    def broken(*given: object, **named: object) -> None:
        raise RuntimeError("broken on purpose")

    BlenderEdit.drag = broken
    try:
        window.move(*window.pixel((0.8, 0.0, 0.0)))
        yield from ended(window)
    finally:
        BlenderEdit.drag = original
    assert box().location.length == 0.0
    assert not window.leftovers(), window.leftovers()


_ALL = (
    kinds_switch,
    typed_components,
    typed_expression,
    local_axes,
    precision,
    snap_to_steps,
    snap_to_vertex,
    snap_to_face,
    pivot_at_cursor,
    individual_origins,
    proportional,
    proportional_lattice,
    view_navigation,
    redo_panel,
    repeat_last,
    interference_switched,
    others_give_way,
    fault_within,
)
GRAMMAR = {scenario.__name__: scenario for scenario in _ALL}
