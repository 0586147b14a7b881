# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from views import VIEWS, looking, typed

from stiv_addon.modal.axis_lock import AxisLock
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.state import State
from stiv_addon.transform.frame import Frame, orthonormal
from stiv_addon.transform.translation import requested_translation
from stiv_addon.transform.view import View

PIVOT = np.array([0.2, 0.1, -0.3])
TILTED = orthonormal(np.array([[1.0, -0.5, 0.2], [0.4, 1.0, 0.1], [-0.3, 0.2, 1.0]]))
LOCKS = [AxisLock(axis, plane) for axis in range(3) for plane in (False, True)]
PIXELS = st.tuples(st.floats(100, 700), st.floats(100, 500))


def dragged(start: tuple, end: tuple, lock: AxisLock, frame: Frame) -> np.ndarray:
    state = State(Pointer.at(start).moved(end), axis_lock=lock)
    return requested_translation(state, frame).vector


@pytest.mark.parametrize("view", VIEWS.values(), ids=VIEWS)
@given(end=PIXELS)
def test_a_free_drag_keeps_the_pivot_under_the_pointer(view: View, end: tuple) -> None:
    start = view.project(PIVOT)
    vector = dragged(start, end, AxisLock(), Frame(PIVOT, view=view))
    assert view.project(PIVOT + vector) == pytest.approx(end, abs=1e-5)


@pytest.mark.parametrize("lock", LOCKS, ids=lambda lock: lock.label)
@pytest.mark.parametrize("view", VIEWS.values(), ids=VIEWS)
@given(start=PIXELS, end=PIXELS)
def test_a_locked_drag_stays_on_its_axes(view: View, lock: AxisLock, start: tuple, end: tuple) -> None:
    vector = dragged(start, end, lock, Frame(PIVOT, TILTED, view))
    locked_out = [axis for axis in range(3) if axis not in lock.axes]
    assert np.isfinite(vector).all()
    np.testing.assert_allclose(TILTED[:, locked_out].T @ vector, 0.0, atol=1e-9 * max(1.0, np.abs(vector).max()))


@pytest.mark.parametrize("lock", LOCKS, ids=lambda lock: lock.label)
@pytest.mark.parametrize("view", [VIEWS["corner parallel"], VIEWS["corner perspective"]])
@given(amount=st.tuples(*[st.floats(-0.5, 0.5)] * 3))
def test_the_pivot_moves_to_the_pointed_position(view: View, lock: AxisLock, amount: tuple) -> None:
    wanted = sum(TILTED[:, axis] * amount[axis] for axis in lock.axes)
    vector = dragged(view.project(PIVOT), view.project(PIVOT + wanted), lock, Frame(PIVOT, TILTED, view))
    np.testing.assert_allclose(vector, wanted, atol=1e-5)


@pytest.mark.parametrize("view", VIEWS.values(), ids=VIEWS)
@pytest.mark.parametrize("lock", [AxisLock(), *LOCKS], ids=lambda lock: lock.label)
def test_a_pointer_that_comes_back_gives_exactly_nothing(view: View, lock: AxisLock) -> None:
    state = State(Pointer.at((300.0, 200.0)).moved((431.0, 77.0)).moved((300.0, 200.0)), axis_lock=lock)
    assert not requested_translation(state, Frame(PIVOT, TILTED, view)).vector.any()


@pytest.mark.parametrize("parallel", [True, False])
def test_an_axis_in_the_line_of_sight_follows_the_pointer_up_and_down(parallel: bool) -> None:
    frame = Frame(np.zeros(3), view=looking((0, 0, 10), parallel=parallel))
    down = dragged((400.0, 300.0), (400.0, 200.0), AxisLock(2), frame)
    assert down[2] > 0.1 and not down[:2].any()
    np.testing.assert_allclose(dragged((400.0, 300.0), (400.0, 400.0), AxisLock(2), frame), -down, atol=1e-9)


def test_beyond_the_horizon_the_motion_stays_in_proportion() -> None:
    view = looking((0, -10, 0.5))
    frame = Frame(np.zeros(3), view=view)
    vector = dragged((400.0, 300.0), (400.0, 590.0), AxisLock(1), frame)
    assert np.linalg.norm(vector) < 1000.0


@pytest.mark.parametrize("lock", [AxisLock(), *LOCKS], ids=lambda lock: lock.label)
def test_a_typed_number_applies_to_the_first_free_axis(lock: AxisLock) -> None:
    state = State(Pointer.at((0.0, 0.0)).moved((50.0, 50.0)), axis_lock=lock, typed=typed("-2.5"))
    vector = requested_translation(state, Frame(PIVOT, TILTED, VIEWS["top"])).vector
    np.testing.assert_allclose(vector, -2.5 * TILTED[:, lock.axes[0]])


@pytest.mark.parametrize("lock", [AxisLock(), AxisLock(0, plane=True), AxisLock(1, plane=True)])
def test_typed_numbers_apply_to_the_free_axes_in_order(lock: AxisLock) -> None:
    state = State(Pointer.at((0.0, 0.0)), axis_lock=lock, typed=typed("1", "", "3").limited(len(lock.axes)))
    vector = requested_translation(state, Frame(PIVOT, TILTED)).vector
    expected = TILTED[:, list(lock.axes)] @ [1.0, 0.0, 3.0][: len(lock.axes)]
    np.testing.assert_allclose(vector, expected, atol=1e-12)


def test_an_axis_pressed_twice_is_that_of_the_second_choice() -> None:
    state = State(Pointer.at((0.0, 0.0)), axis_lock=AxisLock(1, second=True), typed=typed("2"))
    vector = requested_translation(state, Frame(PIVOT, np.eye(3), second_axes=TILTED)).vector
    np.testing.assert_allclose(vector, 2.0 * TILTED[:, 1])


def test_a_sign_alone_moves_nothing() -> None:
    state = State(Pointer.at((0.0, 0.0)), typed=typed("-"))
    assert not requested_translation(state, Frame(PIVOT)).vector.any()


def test_the_matrix_moves_points_by_the_vector() -> None:
    state = State(Pointer.at((0.0, 0.0)), typed=typed("3"))
    matrix = requested_translation(state, Frame(PIVOT)).matrix(Frame(PIVOT))
    np.testing.assert_array_equal(matrix @ [1.0, 2.0, 3.0, 1.0], [4.0, 2.0, 3.0, 1.0])
