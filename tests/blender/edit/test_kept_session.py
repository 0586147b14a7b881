# SPDX-License-Identifier: GPL-3.0-or-later
"""The next edit uses the session of the last one only if nothing else changed."""

from collections.abc import Callable

import bpy
import numpy as np
import pytest
from building import add_cube, add_modifier, cube_above_floor, edit_mode, shift

from stiv.blender import BlenderEdit, EditSettings, check_scene
from stiv.blender.edit import kept_session
from stiv.blender.edit.sessions import deformation_of


def pressed(depth: float) -> BlenderEdit:
    """A finished edit that presses the edited cage onto the floor."""
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.apply(shift(z=-depth))
    assert edit.write().passed
    return edit


def cage() -> bpy.types.Object:
    cube = cube_above_floor()
    add_modifier(cube, "SUBSURF", levels=2)
    edit_mode(cube)
    return cube


def test_consecutive_edits_share_a_session_and_end_as_with_one_each() -> None:
    def heights(shares: bool) -> tuple[bool, np.ndarray]:
        cage()
        first = pressed(1.0)
        session = first._solver.session
        if shares:
            first.finish()
        second = pressed(0.2)
        return second._solver.session is session, second.surface

    shared, together = heights(True)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    fresh, apart = heights(False)
    assert shared
    assert not fresh
    assert together == pytest.approx(apart, abs=1e-4)


def test_consecutive_drags_share_a_session() -> None:
    cage()
    sessions = []
    for depth in (0.3, 1.0, 0.2):
        edit = BlenderEdit.begin(bpy.context, EditSettings(time_budget=0.5), kind="move")
        sessions.append(edit._solver.session)
        for part in (0.5, 1.0):
            edit.drag(shift(z=-part * depth), time_budget=0.5)
        edit.settle()
        assert edit.write().passed
        edit.finish()
    assert sessions[0] is sessions[1] is sessions[2]


def test_a_kept_deformation_is_that_of_the_present_scene() -> None:
    cage()
    first = pressed(1.0)
    deformation = first._solver.deformation
    first.finish()
    second = pressed(0.2)
    assert second._solver.deformation is deformation
    fresh = deformation_of(second.assembly, second.control_sets)
    for controls in (second.controls, second.controls + (0, 0, 0.25)):
        assert np.array_equal(deformation.surface(controls), fresh.surface(controls))


def test_an_obstacle_moved_between_two_edits_is_where_it_is_now() -> None:
    cage()
    pressed(1.0).finish()
    bpy.data.objects["Floor"].location.z -= 0.5
    bpy.context.view_layer.update()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    floor = [mesh.owner.name for mesh in edit.assembly.meshes].index("Floor")
    shown = edit.surface_of(edit.controls)[edit.assembly.vertices(floor)]
    assert (shown[:, 2] == -0.5).all()


def test_a_modifier_changed_by_hand_between_two_edits_is_seen() -> None:
    """It changes neither vertices nor faces of the obstacle, only where it is shown."""
    cube = cage()
    bpy.ops.object.mode_set(mode="OBJECT")
    displace = add_modifier(bpy.data.objects["Floor"], "DISPLACE", strength=0.0)
    edit_mode(cube)
    first = pressed(3.0)
    session, low = first._solver.session, first.moving_points(first.controls)[:, 2].min()
    first.finish()
    displace.strength = -0.5
    bpy.context.view_layer.update()
    second = pressed(3.0)
    assert second._solver.session is not session
    assert second.moving_points(second.controls)[:, 2].min() < low - 0.2 and check_scene(bpy.context).pairs == ()


@pytest.mark.parametrize(
    "change",
    [
        lambda cube: add_cube("Another", (5, 0, 0)),
        lambda cube: setattr(bpy.data.objects["Floor"], "location", (0, 0, -0.5)),
        lambda cube: setattr(cube.modifiers[0], "levels", 1),
    ],
)
def test_a_change_of_the_scene_ends_the_session(change: Callable[[bpy.types.Object], object]) -> None:
    cube = cage()
    edit = pressed(1.0)
    session = edit._solver.session
    edit.finish()
    change(cube)
    bpy.context.view_layer.update()
    assert BlenderEdit.begin(bpy.context, EditSettings(), "move")._solver.session is not session
    assert kept_session._kept is None
