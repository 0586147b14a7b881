# SPDX-License-Identifier: GPL-3.0-or-later
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from views import VIEWS, looking, typed

from stiv_addon.modal.axis_lock import AxisLock
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.request import Request
from stiv_addon.modal.state import State
from stiv_addon.transform.frame import Frame
from stiv_addon.transform.rotation import Rotation, requested_rotation
from stiv_addon.transform.view import View

PIVOT = np.array([0.2, 0.1, -0.3])


def turned(view: View, quarter_turns: int, constraint: AxisLock) -> np.ndarray:
    """The matrix after a motion of the pointer around the pivot."""
    centre = view.project(PIVOT)
    pointer = Pointer.at((centre[0] + 100.0, centre[1]), centre)
    for i in range(1, 3 * abs(quarter_turns) + 1):
        angle = math.copysign(i, quarter_turns) * math.pi / 6.0
        pointer = pointer.moved((centre[0] + 100.0 * math.cos(angle), centre[1] + 100.0 * math.sin(angle)))
    frame = Frame(PIVOT, view=view)
    return requested_rotation(State(pointer, axis_lock=constraint), frame).matrix(frame)


@pytest.mark.parametrize("view", [VIEWS["top"], VIEWS["corner parallel"], looking((6, -5, 4), tuple(PIVOT))])
@pytest.mark.parametrize(("quarters", "sign"), [(-1, -1.0), (1, 1.0), (5, 1.0)])
def test_a_rotation_without_a_lock_turns_the_image_with_the_pointer(view: View, quarters: int, sign: float) -> None:
    x, y = view.project(PIVOT)
    right, up = (view.at_depth_of(pixel, PIVOT) - PIVOT for pixel in [(x + 100.0, y), (x, y + 100.0)])
    matrix = turned(view, quarters, AxisLock())
    np.testing.assert_allclose(matrix[:3, :3] @ right, sign * up, atol=1e-6)
    np.testing.assert_allclose(matrix @ np.append(PIVOT, 1.0), np.append(PIVOT, 1.0), atol=1e-9)


@pytest.mark.parametrize(("eye", "sign"), [((0, 0, 10), 1.0), ((0, 0, -10), -1.0)])
def test_an_axis_seen_from_behind_turns_the_other_way(eye: tuple, sign: float) -> None:
    matrix = turned(looking(eye, parallel=True), 1, AxisLock(2))
    np.testing.assert_allclose(matrix[:3, :3], [[0, -sign, 0], [sign, 0, 0], [0, 0, 1]], atol=1e-6)


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("plane", [False, True])
def test_typed_degrees_turn_counter_clockwise_about_the_locked_axis(axis: int, plane: bool) -> None:
    state = State(Pointer.at((0.0, 0.0)), Request("rotate"), AxisLock(axis, plane), typed("90"))
    matrix = requested_rotation(state, Frame(PIVOT, view=VIEWS["below perspective"])).matrix(Frame(np.zeros(3)))
    following = np.eye(3)[(axis + 1) % 3]
    np.testing.assert_allclose(matrix[:3, :3] @ following, np.eye(3)[(axis + 2) % 3], atol=1e-12)


@given(st.floats(-20.0, 20.0), st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda axis: np.linalg.norm(axis) > 0.1))
def test_matrices_are_rotations_about_axis_and_pivot(angle: float, axis: tuple) -> None:
    unit = np.array(axis) / np.linalg.norm(axis)
    matrix = Rotation(angle, unit).matrix(Frame(PIVOT))
    linear = matrix[:3, :3]
    np.testing.assert_allclose(linear @ linear.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(linear) == pytest.approx(1.0)
    assert np.trace(linear) == pytest.approx(1.0 + 2.0 * math.cos(angle))
    on_axis = np.append(PIVOT + 3.0 * unit, 1.0)
    np.testing.assert_allclose(matrix @ on_axis, on_axis, atol=1e-12)
