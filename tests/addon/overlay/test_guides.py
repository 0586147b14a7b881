# SPDX-License-Identifier: GPL-3.0-or-later
"""The lines of a drag: axes of a constraint, circle of proportional editing."""

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

from stiv_addon.modal.axis_lock import AxisLock  # noqa: E402
from stiv_addon.modal.pointer import Pointer  # noqa: E402
from stiv_addon.modal.proportional import Proportional  # noqa: E402
from stiv_addon.modal.request import Request  # noqa: E402
from stiv_addon.modal.state import State  # noqa: E402
from stiv_addon.overlay import guides  # noqa: E402
from stiv_addon.transform.frame import Frame  # noqa: E402

PIVOT = np.array([1.0, 2.0, 3.0])
TURNED = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])  # about z by 90 degrees
FRAME = Frame(PIVOT, second_axes=TURNED)


def state(axis_lock: AxisLock = AxisLock(), proportional: Proportional = Proportional()) -> State:  # noqa: B008
    """The state of a move."""
    return State(Pointer.at((0.0, 0.0)), Request("move"), axis_lock, proportional=proportional)


def test_a_free_drag_has_no_guides() -> None:
    assert guides.guides_of(state(), FRAME) is None


def test_a_lock_shows_its_axes() -> None:
    found = guides.guides_of(state(AxisLock(0)), FRAME)
    assert found is not None and found.radius is None
    assert found.axes == ((0, (1.0, 0.0, 0.0)),)
    plane = guides.guides_of(state(AxisLock(0, plane=True)), FRAME)
    assert plane is not None and [axis for axis, _ in plane.axes] == [1, 2]
    second = guides.guides_of(state(AxisLock(0, second=True)), FRAME)
    assert second is not None and second.axes == ((0, (0.0, 1.0, 0.0)),)


def test_proportional_editing_shows_its_size() -> None:
    found = guides.guides_of(state(proportional=Proportional(True, True, 2.5)), FRAME)
    assert found == guides.Guides((1.0, 2.0, 3.0), (), 2.5)
    assert guides.guides_of(state(proportional=Proportional(True, False, 2.5)), FRAME) is None
    assert guides.guides_of(state(proportional=Proportional(False, True, 2.5)), FRAME) is None


def test_the_circle_has_its_radius_and_faces_the_viewer() -> None:
    view = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    points = guides.circle(PIVOT, 2.5, view)
    assert np.linalg.norm(points - PIVOT, axis=1) == pytest.approx(2.5)
    assert (points - PIVOT) @ view[:, 2] == pytest.approx(0.0, abs=1e-12)
    assert points[0] == pytest.approx(points[-1])


def test_the_line_of_an_axis_passes_the_pivot() -> None:
    ends = guides.axis_line(PIVOT, np.array([0.0, 0.0, 1.0]), 100.0)
    assert ends.mean(axis=0) == pytest.approx(PIVOT)
    assert ends[1] - ends[0] == pytest.approx([0.0, 0.0, 200.0])
