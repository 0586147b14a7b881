# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard with Blender's own G in Edit Mode, of a cage and of a lattice."""

from __future__ import annotations

import bpy
import scenes
from guard_scenarios import at_rest, guarded, with_tool
from playing import INTO_WALL, expect_free, expect_near
from scenes import WALL_FACE
from simulation import Steps, Window


def guard_cage(window: Window) -> Steps:
    """Vertices of a cage in Edit Mode with Blender's G."""
    yield from guarded(window, scenes.add_cage, "Cage", "EDIT")
    scenes.set_levels(2, 3)
    with window.override():
        bpy.ops.ed.undo_push(message="Levels")
    yield from at_rest(window)
    before = scenes.evaluated_extent("Cage")
    yield from with_tool(window, "G", INTO_WALL)
    expect_near(scenes.evaluated_extent("Cage"), WALL_FACE, 0.1, "the surface at the wall")
    assert scenes.evaluated_extent("Cage") < WALL_FACE
    expect_free(window)
    window.picture("guard_cage")
    yield from window.undo()
    yield from at_rest(window)
    expect_near(scenes.evaluated_extent("Cage"), before, 1e-6, "the surface after undo")
    assert scenes.levels() == (2, 3)  # set since Edit Mode began, and not part of the mesh
    yield from window.redo()
    yield from at_rest(window)
    assert scenes.evaluated_extent("Cage") < WALL_FACE
    expect_free(window)


def guard_lattice(window: Window) -> Steps:
    """Points of a lattice in Edit Mode with Blender's G."""
    yield from guarded(window, scenes.add_ball_in_lattice, "Lattice", "EDIT")
    before = scenes.evaluated_extent("Ball")
    yield from with_tool(window, "G", INTO_WALL)
    assert before < scenes.evaluated_extent("Ball") < WALL_FACE
    expect_free(window)
    yield from window.undo()
    yield from at_rest(window)
    expect_near(scenes.evaluated_extent("Ball"), before, 1e-6, "the ball after undo")


GUARD_EDIT_MODE = {scenario.__name__: scenario for scenario in (guard_cage, guard_lattice)}
