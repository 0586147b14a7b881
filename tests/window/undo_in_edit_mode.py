# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl+Z in Edit Mode after evaluations that copy objects.

Settings changed since Edit Mode began, such as a modifier's levels, are not part of the mesh, and stay as they are.
"""

from __future__ import annotations

import bmesh
import bpy
import scenes
from guard_scenarios import steps
from playing import INTO_WALL, click, prepared, start
from simulation import Steps, Window

LEVELS = (1, 3)  # viewport and render differ, so the cage is copied
SUCCEED = {"check": "Check", "exclude_intersections": "Exclude Collisions", "contract": "Contract", "let_pass": "Pass"}
REFUSED = ("repair", "let_pass", "measure")  # where nothing intersects; or without a step


class STIVTEST_OT_move(bpy.types.Operator):  # noqa: N801 (as Blender names operators)
    """Calls an operator of STIV, as another add-on may"""

    bl_idname = "stivtest.move"
    bl_label = "Other"
    bl_options = {"UNDO"}  # noqa: RUF012 (Blender reads a set)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Move the selection."""
        bpy.ops.stiv.move(value=(-0.5, 0.0, 0.0))
        return {"FINISHED"}


def undo_after_operators(window: Window) -> Steps:
    """Ctrl+Z takes back an operator in one step, and the next one no setting either."""
    for name, label in SUCCEED.items():
        yield from _begun(window, cuts=name in ("exclude_intersections", "let_pass"))
        before, history = _state(), steps()
        yield from _called(window, name)
        after = _state()
        assert len(steps()) == len(history) + 1 and label in steps()[-1], (name, steps())
        yield from window.undo()
        assert _state() == before, (name, _state(), before)
        yield from window.redo()
        assert _state() == after, (name, _state(), after)
        yield from _tool_undone(window, name)


def undo_after_refusals(window: Window) -> Steps:
    """Refused and cancelled operators, and those that only measure, leave the undo history as it is."""
    for name in REFUSED:
        yield from _begun(window)
        history = steps()
        yield from _called(window, name)
        assert steps() == history, (name, steps(), history)
        yield from _tool_undone(window, name)
    yield from _begun(window)
    yield from _cancelled_drag(window)
    yield from _tool_undone(window, "a cancelled drag")


def undo_after_a_cancelled_drag_before_redo(window: Window) -> Steps:
    """A cancelled drag leaves what can be redone; the undo after it keeps the settings again."""
    yield from _begun(window)
    yield from _tool(window)
    after, history = _state(), steps()
    yield from window.undo()
    yield from _cancelled_drag(window)
    assert steps() == history, (steps(), history)
    yield from window.redo()
    assert _state() == after, (_state(), after)
    yield from _tool_undone(window, "redo")


def undo_after_scripts(window: Window) -> Steps:
    """Operators that scripts call, or operators of other add-ons, and the redo panel."""
    for name, properties in (("move", {"value": (-0.5, 0.0, 0.0)}), ("contract", {}), ("exclude_intersections", {})):
        yield from _begun(window, cuts=name == "exclude_intersections")
        before = _state()
        with window.override():
            getattr(bpy.ops.stiv, name)("EXEC_DEFAULT", True, **properties)
            after = _state()
            bpy.ops.ed.undo_redo("EXEC_DEFAULT", True)  # what a change in the panel does
        yield from window.settle()
        assert _state() == after, (name, _state(), after)
        yield from window.undo()
        assert _state() == before, (name, _state(), before)
    yield from _begun(window)
    before = _state()
    bpy.utils.register_class(STIVTEST_OT_move)
    try:
        with window.override():
            bpy.ops.stivtest.move("EXEC_DEFAULT", True)
    finally:
        bpy.utils.unregister_class(STIVTEST_OT_move)
    assert _state() != before
    yield from window.undo()
    assert _state() == before, (_state(), before)


def undo_after_a_cancelled_drag_of_a_lattice(window: Window) -> Steps:
    """Its points at rest are read from a copy."""
    yield from prepared(window, scenes.add_ball_in_lattice, "Lattice", "EDIT")
    bpy.data.objects["Ball"].modifiers[0].strength = 0.5
    with window.override():
        bpy.ops.ed.undo_push(message="Strength")
    before = scenes.evaluated_extent("Ball")
    yield from _cancelled_drag(window)
    yield from _tool(window)
    assert scenes.evaluated_extent("Ball") < before
    yield from window.undo()
    assert scenes.evaluated_extent("Ball") == before and bpy.data.objects["Ball"].modifiers[0].strength == 0.5


def _begun(window: Window, cuts: bool = False) -> Steps:
    """A cage in Edit Mode, and settings changed since then: its levels, and the place of the wall."""
    yield from prepared(window, scenes.add_cage, "Cage", "EDIT")
    scenes.set_levels(*LEVELS)
    if cuts:
        bpy.data.objects["Wall"].location.x = 0.4
    with window.override():
        bpy.ops.ed.undo_push(message="Levels")


def _state() -> tuple[object, ...]:
    """The mode, and all that undo has to restore."""
    layers = bmesh.from_edit_mesh(bpy.data.objects["Cage"].data).verts.layers.float_vector
    scene = bpy.context.scene
    places = scenes.levels(), bpy.data.objects["Wall"].location.x, scenes.evaluated_extent("Cage")
    return bpy.context.mode, places, len(layers), len(scene.stiv.passing_pairs), scene.stiv.excluded


def _called(window: Window, name: str) -> Steps:
    """Call an operator as a button does, and wait for its end."""
    with window.override():
        getattr(bpy.ops.stiv, name)("INVOKE_DEFAULT", True)
    yield from window.until(lambda: not window.dragging(), f"the end of {name}")
    yield from window.settle()


def _cancelled_drag(window: Window) -> Steps:
    yield from window.rest_at((0.0, 0.0, 0.0))
    yield from start(window)
    yield from window.glide(window.pixel(INTO_WALL))
    yield from click(window, "ESC")


def _tool(window: Window) -> Steps:
    """One of Blender's own tools."""
    with window.override():
        bpy.ops.transform.translate("EXEC_DEFAULT", True, value=(-0.3, 0.0, 0.0))
    yield from window.settle()


def _tool_undone(window: Window, what: str) -> Steps:
    """Blender's own tool, and Ctrl+Z."""
    before = _state()
    yield from _tool(window)
    assert _state() != before
    yield from window.undo()
    assert _state() == before, (what, _state(), before)


_ALL = (
    undo_after_operators,
    undo_after_refusals,
    undo_after_a_cancelled_drag_before_redo,
    undo_after_scripts,
    undo_after_a_cancelled_drag_of_a_lattice,
)
UNDO_IN_EDIT_MODE = {scenario.__name__: scenario for scenario in _ALL}
