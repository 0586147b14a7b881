# SPDX-License-Identifier: GPL-3.0-or-later
"""The lines of a drag: axes of a constraint, circle of proportional editing, line to the pointer."""

from dataclasses import replace

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


def turning(kind: str, centre: tuple[float, float] | None = (100.0, 50.0)) -> State:
    """The state of a drag whose pointer has moved precisely: the line follows the pointer itself."""
    pointer = Pointer.at((140.0, 50.0), centre).moved((160.0, 90.0), precise=True)
    return State(pointer, Request(kind))


@pytest.mark.parametrize("kind", ["rotate", "scale"])
def test_a_line_joins_the_pivot_and_the_pointer_of_a_rotation_or_scaling(kind: str) -> None:
    found = guides.guides_of(turning(kind), FRAME)
    assert found is not None and found.pointer_line == ((100.0, 50.0), (160.0, 90.0))


def test_other_drags_have_no_line_to_the_pointer() -> None:
    assert guides.guides_of(turning("move"), FRAME) is None
    assert guides.guides_of(turning("rotate", centre=None), FRAME) is None
    assert guides.guides_of(replace(turning("rotate"), trackball=True), FRAME) is None


def test_dashes_begin_at_the_pivot_and_end_at_the_pointer() -> None:
    found = guides.dashes((10.0, 20.0), (10.0, 42.0), 8.0)
    assert found[:, 0] == pytest.approx(10.0)
    assert found[:, 1] == pytest.approx([20.0, 24.0, 28.0, 32.0, 36.0, 40.0])
    assert guides.dashes((0.0, 0.0), (3.0, 4.0), 16.0) == pytest.approx(np.array([[0.0, 0.0], [3.0, 4.0]]))
    assert len(guides.dashes((1.0, 1.0), (1.0, 1.0), 8.0)) == 0


def test_a_pivot_far_outside_the_region_has_a_bounded_number_of_dashes() -> None:
    assert len(guides.dashes((1e9, 0.0), (0.0, 0.0), 8.0)) <= 2 * guides.MOST_DASHES + 2
