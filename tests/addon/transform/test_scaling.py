# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from views import typed

from stiv_addon.modal.axis_lock import AxisLock
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.request import Request
from stiv_addon.modal.state import State
from stiv_addon.modal.typed_numbers import TypedValues
from stiv_addon.transform.frame import Frame, orthonormal
from stiv_addon.transform.scaling import LEAST_FACTOR, requested_scaling

PIVOT = np.array([0.2, 0.1, -0.3])
CENTRE = (400.0, 300.0)
TILTED = orthonormal(np.array([[1.0, -0.5, 0.2], [0.4, 1.0, 0.1], [-0.3, 0.2, 1.0]]))
LOCKS = [AxisLock(), *(AxisLock(axis, plane) for axis in range(3) for plane in (False, True))]


def factor(start: tuple, end: tuple) -> float:
    return requested_scaling(State(Pointer.at(start, CENTRE).moved(end)), Frame(PIVOT)).factors[0]


def test_the_factor_is_the_ratio_of_distances() -> None:
    assert factor((500.0, 300.0), (650.0, 300.0)) == 2.5
    assert factor((500.0, 300.0), (400.0, 250.0)) == 0.5
    assert factor((500.0, 300.0), (500.0, 300.0)) == 1.0


def test_the_pointer_alone_cannot_collapse_or_mirror() -> None:
    assert factor((500.0, 300.0), CENTRE) == LEAST_FACTOR
    assert factor(CENTRE, (410.0, 300.0)) == 10.0


@pytest.mark.parametrize("lock", LOCKS, ids=lambda lock: lock.label)
def test_only_the_free_axes_are_scaled(lock: AxisLock) -> None:
    state = State(Pointer.at((500.0, 300.0), CENTRE), Request("scale"), lock, typed("3"))
    frame = Frame(PIVOT, TILTED)
    matrix = requested_scaling(state, frame).matrix(frame)
    for axis in range(3):
        point = np.append(PIVOT + TILTED[:, axis], 1.0)
        expected = PIVOT + TILTED[:, axis] * (3.0 if axis in lock.axes else 1.0)
        np.testing.assert_allclose((matrix @ point)[:3], expected, atol=1e-12)
    np.testing.assert_allclose(matrix @ np.append(PIVOT, 1.0), np.append(PIVOT, 1.0), atol=1e-12)


@pytest.mark.parametrize(("typed_values", "expected"), [(typed("-"), 1.0), (typed("-2"), -2.0)])
def test_typed_factors(typed_values: TypedValues, expected: float) -> None:
    assert requested_scaling(State(Pointer.at((0.0, 0.0)), typed=typed_values), Frame(PIVOT)).factors[0] == expected


def test_typed_factors_apply_to_their_axes() -> None:
    state = State(Pointer.at((0.0, 0.0)), Request("scale"), typed=typed("2", "", "4"))
    np.testing.assert_array_equal(requested_scaling(state, Frame(PIVOT)).factors, [2.0, 1.0, 4.0])


@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 2, 3), (1e-6, 1, 1e6)])
def test_axes_of_scaled_mirrored_and_sheared_objects_are_made_orthonormal(scale: tuple) -> None:
    axes = orthonormal(TILTED @ np.diag(scale) + np.array([[0, 0.1, 0]] * 3) * scale[1])
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-9)
    np.testing.assert_allclose(axes[:, 0], TILTED[:, 0] * np.sign(scale[0]), atol=1e-9)


@pytest.mark.parametrize("collapsed", [np.zeros((3, 3)), np.ones((3, 3)), np.diag([1.0, 0.0, 0.0])])
def test_degenerate_axes_give_those_of_the_world(collapsed: np.ndarray) -> None:
    np.testing.assert_array_equal(orthonormal(collapsed), np.eye(3))
