# SPDX-License-Identifier: GPL-3.0-or-later
"""Drags that deform: cages and lattices, in Edit Mode and as whole objects."""

from __future__ import annotations

import bpy
import scenes
from mathutils import Vector
from playing import INTO_WALL, click, expect_free, expect_near, prepared, start
from scenes import WALL_FACE
from simulation import Steps, Window

IN_WALL = (1.7, 0.0, 0.0)  # the way around the wall comes no closer to this goal; to a further one, soft points find it


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
    yield from _drag_again(window)
    yield from click(window, "ESC")
    assert scenes.evaluated_extent("Cage") == before
    yield from _tight_drag(window)


def _drag_again(window: Window) -> Steps:
    """Drag from the middle into the wall, without confirming."""
    yield from window.glide(window.pixel((0.0, 0.0, 0.0)))
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    expect_near(scenes.evaluated_extent("Cage"), WALL_FACE, 0.1, "the surface at the wall while dragging again")


def _tight_drag(window: Window) -> Steps:
    """The same drag with Tight: it ends no further from the wall."""
    bpy.context.scene.stiv.tight = True
    yield from _drag_again(window)
    yield from click(window)
    window.picture("cage_in_edit_mode_tight")
    expect_near(scenes.evaluated_extent("Cage"), WALL_FACE, 0.1, "the surface at the wall after a tight drag")
    assert scenes.evaluated_extent("Cage") < WALL_FACE
    expect_free(window)


def lattice_in_edit_mode(window: Window) -> Steps:
    """Points of a lattice pushed into the wall move the ball with them, up to the wall."""
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
    """The lattice object moved as a whole, responding with its points."""
    yield from prepared(window, scenes.add_ball_in_lattice, "Lattice")
    bpy.context.scene.stiv.object_response = "deform"
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    expect_near(scenes.evaluated_extent("Ball"), WALL_FACE, 0.1, "the ball at the wall while dragging")
    yield from click(window)
    expect_free(window)


def mirrored_cage_in_edit_mode(window: Window) -> Steps:
    """With the mirror option, the wall deflects both sides, and the cage stays symmetric."""
    yield from prepared(window, scenes.add_cage, "Cage", "EDIT")
    mesh = bpy.context.object.data
    mesh.use_mirror_x = True
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    expect_near(scenes.evaluated_extent("Cage"), WALL_FACE, 0.1, "the surface at the wall while dragging")
    window.picture("mirrored_cage_in_edit_mode")
    yield from click(window)
    expect_free(window)
    bpy.context.object.update_from_editmode()
    points = [vertex.co for vertex in mesh.vertices]
    apart = max(min((point - Vector((-other.x, other.y, other.z))).length for other in points) for point in points)
    expect_near(apart, 0.0, 1e-5, "the distance of vertices from their mirror images")


def curve_in_edit_mode(window: Window) -> Steps:
    """Points of a bevelled curve pushed into the wall: its tube bends along it."""
    yield from prepared(window, scenes.add_curve, "Curve", "EDIT")
    before = scenes.evaluated_extent("Curve")
    yield from start(window)
    yield from window.glide(window.pixel(IN_WALL))
    expect_near(scenes.evaluated_extent("Curve"), WALL_FACE, 0.1, "the curve at the wall while dragging")
    window.picture("curve_in_edit_mode")
    yield from click(window)
    assert bpy.context.mode == "EDIT_CURVE"
    assert scenes.evaluated_extent("Curve") < WALL_FACE
    expect_free(window)
    yield from window.undo()
    assert scenes.evaluated_extent("Curve") == before


def piece_with_modifiers(window: Window) -> Steps:
    """A mirrored, bevelled piece with smooth shading by angle, pushed with its vertices against a body."""
    yield from prepared(window, scenes.add_mirrored_piece, "Piece", "EDIT")
    bpy.context.scene.stiv.guard = "both"
    before = scenes.evaluated_extent("Piece")
    with window.override():
        scenes.look_from_corner(window.area)
    yield from window.settle()
    yield from start(window)
    window.key("X")
    yield from window.glide(window.pixel(INTO_WALL))
    assert scenes.evaluated_extent("Piece") > before + 0.2, "the piece at the body while dragging"
    assert len(bpy.data.scenes) == 2, "the copy that Blender evaluates stays during a drag"
    window.picture("piece_with_modifiers")
    window.key("LEFTMOUSE")
    yield from window.until(lambda: not window.dragging(), "the end of the transform", 120)
    assert len(bpy.data.scenes) == 1
    expect_free(window)
    yield from window.undo()
    expect_near(scenes.evaluated_extent("Piece"), before, 1e-6, "the surface after undo")
    assert len(bpy.data.scenes) == 1
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    yield from click(window, "ESC")
    assert scenes.evaluated_extent("Piece") == before and len(bpy.data.scenes) == 1


def undo_keeps_what_was_changed_in_edit_mode(window: Window) -> Steps:
    """Ctrl+Z after a drag takes back the drag alone: not the modifier's levels, changed since Edit Mode began."""
    yield from prepared(window, scenes.add_cage, "Cage", "EDIT")
    scenes.set_levels(1, 3)
    with window.override():
        bpy.ops.ed.undo_push(message="Levels")
    before = scenes.evaluated_extent("Cage")
    for _ in range(2):  # the second drag follows steps that were undone
        yield from _drag_again(window)
        yield from click(window)
        after = scenes.evaluated_extent("Cage")
        assert after != before
        yield from window.undo()
        assert (bpy.context.mode, scenes.levels(), scenes.evaluated_extent("Cage")) == ("EDIT_MESH", (1, 3), before)
        yield from window.redo()
        assert (scenes.levels(), scenes.evaluated_extent("Cage")) == ((1, 3), after)
        yield from window.undo()
        assert (scenes.levels(), scenes.evaluated_extent("Cage")) == ((1, 3), before)


_ALL = (
    cage_in_edit_mode,
    curve_in_edit_mode,
    mirrored_cage_in_edit_mode,
    lattice_in_edit_mode,
    lattice_in_object_mode,
    piece_with_modifiers,
    undo_keeps_what_was_changed_in_edit_mode,
)
DEFORMING_DRAGS = {scenario.__name__: scenario for scenario in _ALL}
