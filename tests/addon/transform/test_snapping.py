# SPDX-License-Identifier: GPL-3.0-or-later
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from views import VIEWS, typed

from stiv_addon.modal.axis_lock import AxisLock
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.request import Request
from stiv_addon.modal.state import State
from stiv_addon.transform.frame import Frame
from stiv_addon.transform.rotation import requested_rotation
from stiv_addon.transform.scaling import requested_scaling
from stiv_addon.transform.snapping import GEOMETRY, REACH, Hit, Snap
from stiv_addon.transform.translation import requested_translation
from stiv_addon.transform.view import View

VIEW = VIEWS["top"]
FRAME = Frame(np.zeros(3), view=VIEW)
CORNERS = np.array([[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 2.0, 1.0], [0.0, 2.0, 1.0]])
PIXELS = st.tuples(st.floats(0, 800), st.floats(0, 600))


def seen_at(place: tuple) -> Hit:
    return Hit(np.array(place, float), CORNERS)


def moved(end: tuple, snap: Snap, **chosen: object) -> np.ndarray:
    state = State(Pointer.at((400.0, 300.0)).moved(end), ctrl=True, **chosen)
    return requested_translation(state, FRAME, snap=snap).vector


@given(PIXELS, st.sampled_from([AxisLock(), AxisLock(0), AxisLock(1, plane=True)]), st.booleans())
def test_moves_snap_to_increments_along_the_free_axes(end: tuple, lock: AxisLock, fine: bool) -> None:
    vector = moved(end, Snap(), axis_lock=lock, precise=fine)
    steps = vector / (0.1 if fine else 1.0)
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-9)
    free = requested_translation(State(Pointer.at((400.0, 300.0)).moved(end), axis_lock=lock), FRAME).vector
    assert np.abs(vector - free).max() <= (0.05 if fine else 0.5) + 1e-9


@given(PIXELS)
def test_on_the_grid_the_pivot_snaps(end: tuple) -> None:
    frame = Frame(np.array([0.3, -0.2, 0.7]), view=VIEW)
    state = State(Pointer.at((400.0, 300.0)).moved(end), snap=True)
    place = frame.pivot + requested_translation(state, frame, snap=Snap(frozenset({"GRID"}))).vector
    np.testing.assert_allclose(place, np.round(place), atol=1e-9)


def test_turns_and_factors_snap_to_increments() -> None:
    pointer = Pointer.at((500.0, 300.0), (400.0, 300.0)).moved((513.0, 327.0))
    for fine, degrees, factor in [(False, 5, 0.1), (True, 1, 0.01)]:
        state = State(pointer, Request("rotate"), ctrl=True, precise=fine)
        angle = math.degrees(requested_rotation(state, FRAME, snap=Snap()).angle) / degrees
        assert angle == pytest.approx(round(angle)) and angle != 0
        state = replace(state, request=Request("scale"))
        steps = requested_scaling(state, FRAME, snap=Snap()).factors[0] / factor
        assert steps == pytest.approx(round(steps)) and steps * factor != 1


@pytest.mark.parametrize(
    ("snap", "ctrl", "kind", "expected"),
    [
        (False, False, "move", False),
        (True, False, "move", True),
        (True, True, "move", False),
        (False, True, "rotate", True),
        (True, False, "rotate", False),
    ],
)
def test_ctrl_inverts_snapping(snap: bool, ctrl: bool, kind: str, expected: bool) -> None:
    assert Snap().applies(State(Pointer.at((0.0, 0.0)), Request(kind), snap=snap, ctrl=ctrl)) is expected


@pytest.mark.parametrize(
    ("elements", "place", "expected"),
    [
        ({"VERTEX"}, (1.9, 1.9, 1.0), (2.0, 2.0, 1.0)),
        ({"VERTEX", "EDGE", "FACE"}, (1.9, 1.9, 1.0), (2.0, 2.0, 1.0)),
        ({"EDGE", "FACE"}, (1.9, 1.2, 1.0), (2.0, 1.2, 1.0)),
        ({"EDGE_MIDPOINT", "FACE"}, (1.9, 1.2, 1.0), (2.0, 1.0, 1.0)),
        ({"FACE"}, (1.0, 1.0, 1.0), (1.0, 1.0, 1.0)),
        ({"VERTEX", "FACE"}, (1.0, 1.0, 1.0), (1.0, 1.0, 1.0)),
        ({"VERTEX"}, (1.0, 1.0, 1.0), None),
        ({"INCREMENT"}, (1.9, 1.9, 1.0), None),
    ],
)
def test_the_smallest_element_near_the_pointer_wins(elements: set, place: tuple, expected: tuple | None) -> None:
    pixel = VIEW.project(np.array(place))
    target = Snap(frozenset(elements), cast=lambda at: seen_at(place)).target(pixel, VIEW)
    if expected is None:
        assert target is None
    else:
        np.testing.assert_allclose(target, expected, atol=1e-6)


@pytest.mark.parametrize("view", VIEWS.values(), ids=VIEWS)
@given(pixel=st.tuples(st.floats(200, 600), st.floats(150, 450)))
def test_a_target_is_the_closest_corner_within_reach(view: View, pixel: tuple) -> None:
    """Against brute force over the corners."""
    target = Snap(frozenset({"VERTEX"}), cast=lambda at: seen_at((1, 1, 1))).target(pixel, view)
    distances = [math.dist(view.project(corner), pixel) for corner in CORNERS]
    if target is None:
        assert min(distances) >= REACH - 1e-6
    else:
        assert math.dist(view.project(target), pixel) == pytest.approx(min(distances), abs=1e-6)


@pytest.mark.parametrize(
    ("source", "of_selection"),
    [("CLOSEST", (0, 0, 0)), ("CENTER", (0, 0, 0)), ("MEDIAN", (0.5, 0, 0)), ("ACTIVE", (0, 5, 0))],
)
def test_the_chosen_point_of_the_selection_moves_onto_the_target(source: str, of_selection: tuple) -> None:
    points, active = np.array([[1.0, 0, 0], [0, 0, 0]]), np.array([0.0, 5, 0])
    snap = Snap(frozenset({"VERTEX"}), source=source, points=points, active=active, cast=lambda at: seen_at((2, 2, 1)))
    vector = moved(VIEW.project(CORNERS[2]), snap)
    np.testing.assert_allclose(np.array(of_selection) + vector, CORNERS[2], atol=1e-6)
    locked = moved(VIEW.project(CORNERS[2]), snap, axis_lock=AxisLock(2, plane=True))
    np.testing.assert_allclose((np.array(of_selection) + locked)[:2], CORNERS[2][:2], atol=1e-6)
    assert locked[2] == 0.0


def test_an_outline_is_a_target_from_outside() -> None:
    def look(pixel: tuple) -> Hit | None:
        return seen_at((1.99, 1.0, 1.0)) if pixel[0] < VIEW.project(CORNERS[1])[0] else None

    beside = (VIEW.project(CORNERS[1])[0] + 5.0, VIEW.project(CORNERS[1])[1])
    np.testing.assert_allclose(Snap(frozenset({"VERTEX"}), cast=look).target(beside, VIEW), CORNERS[1])
    assert Snap(frozenset({"FACE"}), cast=look).target(beside, VIEW) is None


@pytest.mark.parametrize("element", GEOMETRY)
def test_typed_numbers_do_not_snap(element: str) -> None:
    snap = Snap(frozenset({element}), cast=lambda at: seen_at((2, 2, 1)))
    assert moved((450.0, 300.0), snap, typed=typed("0.3"))[0] == 0.3
