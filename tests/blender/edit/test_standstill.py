# SPDX-License-Identifier: GPL-3.0-or-later
"""An edit that moves nothing says why: contact, or locks. One that was asked for nothing says nothing."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import add_cube, add_grid, select, shift

from stiv.blender import BlenderEdit, EditSettings


def landed(**properties: Any) -> Any:
    """A selected cube that lies on a floor, as an edit has left it."""
    add_grid("Floor", 4, 3.0)
    cube = add_cube("Cube", (0, 0, 1.5), **properties)
    select(cube)
    drag(shift(z=-2))
    return cube


def drag(matrix: np.ndarray, **settings: Any) -> str:
    """The note at the end of a drag."""
    edit = BlenderEdit.begin(bpy.context, EditSettings(**settings), "move")
    edit.drag(matrix)
    result = edit.settle()
    assert edit.write().passed
    return edit.standstill_note(result)


@pytest.mark.parametrize("response", ["slide", "slide_and_turn"])
def test_a_cube_on_the_floor_names_it(response: str) -> None:
    cube = landed()
    place = tuple(cube.location)
    note = drag(shift(z=-1), object_response=response)
    assert note == "nothing moved: already in contact with Floor"
    assert tuple(cube.location) == pytest.approx(place, abs=1e-6)


def test_a_cube_that_slides_along_the_floor_has_moved() -> None:
    landed()
    assert drag(shift(x=0.5, z=-1)) == ""
    assert drag(shift(z=1)) == ""


def test_a_motion_along_locked_axes_names_the_lock() -> None:
    cube = landed()
    cube.lock_location = (True, False, True)
    assert drag(shift(z=1)) == "Cube: its location is locked along X, Z; unlock it"
    assert drag(shift(y=0.5)) == ""


def test_nothing_is_said_where_nothing_was_to_move() -> None:
    cube = landed()
    assert drag(np.eye(4)) == ""
    cube.lock_location = (False, False, True)
    assert drag(np.eye(4)) == ""


def test_without_collisions_everything_moves() -> None:
    landed()
    assert drag(shift(z=-1), interference=False) == ""
