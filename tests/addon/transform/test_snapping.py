# SPDX-License-Identifier: GPL-3.0-or-later
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from snap_scene import CORNERS, Quad, searching, snapping
from views import VIEWS, typed

from stiv_addon.modal.axis_lock import AxisLock
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.request import Request
from stiv_addon.modal.state import State
from stiv_addon.transform.frame import Frame
from stiv_addon.transform.rotation import requested_rotation
from stiv_addon.transform.scaling import requested_scaling
from stiv_addon.transform.snapping import Snap
from stiv_addon.transform.translation import requested_translation

VIEW = VIEWS["top"]
FRAME = Frame(np.zeros(3), view=VIEW)
PIXELS = st.tuples(st.floats(0, 800), st.floats(0, 600))
MOVES = frozenset({"move"})
ALL = frozenset({"move", "rotate", "scale"})


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
def test_on_the_grid_the_median_goes_to_the_floor_under_the_pointer(end: tuple) -> None:
    for name in ("corner perspective", "corner parallel"):
        frame = Frame(np.array([0.3, -0.2, 0.7]), view=VIEWS[name])
        state = State(Pointer.at((400.0, 300.0)).moved(end), snap=MOVES)
        place = frame.pivot + requested_translation(state, frame, snap=Snap(frozenset({"GRID"}))).vector
        np.testing.assert_allclose(place, np.round(place), atol=1e-9)
    assert moved(VIEW.project(np.array([2.2, -0.9, 0.0])), Snap(frozenset({"GRID"}))).tolist() == [2.0, -1.0, 0.0]


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
        (frozenset(), False, "move", False),
        (MOVES, False, "move", True),
        (MOVES, True, "move", False),
        (frozenset(), True, "rotate", True),
        (MOVES, False, "rotate", False),
        (MOVES, True, "rotate", True),
    ],
)
def test_ctrl_inverts_snapping(snap: frozenset, ctrl: bool, kind: str, expected: bool) -> None:
    assert State(Pointer.at((0.0, 0.0)), Request(kind), snap=snap, ctrl=ctrl).snapping is expected


@pytest.mark.parametrize(
    ("source", "of_selection"),
    [("CLOSEST", (1, 0, 0)), ("CENTER", (0, 0, 0)), ("MEDIAN", (0.5, 0, 0)), ("ACTIVE", (0, 5, 0))],
)
def test_the_chosen_point_of_the_selection_moves_onto_the_target(source: str, of_selection: tuple) -> None:
    """The closest point is closest at the start: where the pointer has dragged it does not count."""
    points, active, median = np.array([[1.0, 0, 0], [0, 0, 0]]), np.array([0.0, 5, 0]), np.array([0.5, 0, 0])
    snap = snapping("VERTEX", source=source, points=points, median=median, active=active)
    vector = moved(VIEW.project(CORNERS[2]), snap)
    np.testing.assert_allclose(np.array(of_selection) + vector, CORNERS[2], atol=1e-6)
    locked = moved(VIEW.project(CORNERS[2]), snap, axis_lock=AxisLock(2, plane=True))
    np.testing.assert_allclose((np.array(of_selection) + locked)[:2], CORNERS[2][:2], atol=1e-6)
    assert locked[2] == 0.0


def test_a_locked_move_ends_where_the_axis_meets_the_face_or_the_edge() -> None:
    tilt = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0.5, 0, 1, 0], [0, 0, 0, 1]])  # z = 1 + x / 2

    class Slope(Quad):
        def cast(self, origin: np.ndarray, direction: np.ndarray) -> tuple | None:
            hit = Quad().cast(origin, direction)
            return None if hit is None else (hit[0], np.linalg.inv(tilt[:3, :3]).T @ hit[1], 0)

    snap = snapping("FACE", source="CENTER", search=searching(Slope(matrix=tilt)))
    pixel = VIEW.project(np.array([1.0, 1.0, 0.0]))
    place = moved(pixel, snap, axis_lock=AxisLock(2))
    normal = tilt[:3, :3] @ (np.linalg.inv(tilt[:3, :3]).T @ [0.0, 0.0, 1.0])
    assert place[:2].tolist() == [0.0, 0.0]
    assert (place - [1.0, 1.0, 1.5]) @ normal == pytest.approx(0.0, abs=1e-5)
    edge = snapping("EDGE", source="CENTER")
    across = moved(VIEW.project(np.array([2.0, 1.3, 1.0])), edge, axis_lock=AxisLock(0))
    np.testing.assert_allclose(across, (2, 0, 0), atol=1e-6)


@pytest.mark.parametrize("name", VIEWS)
@pytest.mark.parametrize("lock", [AxisLock(), AxisLock(1)])
def test_a_rotation_turns_the_source_toward_the_target(name: str, lock: AxisLock) -> None:
    view = VIEWS[name]
    frame = Frame(np.array([0.2, -0.3, 0.1]), view=view)
    snap = snapping("VERTEX", points=np.array([[1.0, -0.4, 0.3]]), kinds=ALL)
    state = State(Pointer.at((0.0, 0.0)).moved(view.project(CORNERS[2])), Request("rotate"), snap=ALL, axis_lock=lock)
    rotation = requested_rotation(state, frame, snap=snap)
    turned = rotation.matrix(frame) @ [1.0, -0.4, 0.3, 1.0]
    axis = rotation.axis
    arms = [arm - axis * (axis @ arm) for arm in (turned[:3] - frame.pivot, CORNERS[2] - frame.pivot)]
    first, second = (arm / np.linalg.norm(arm) for arm in arms)
    np.testing.assert_allclose(first, second, atol=1e-9)


def test_a_scaling_takes_the_source_to_the_height_of_the_target() -> None:
    snap = snapping("VERTEX", points=np.array([[1.0, 1.0, 0.5], [0.1, 0.0, 0.0]]), kinds=ALL)
    state = State(Pointer.at((0.0, 0.0)).moved(VIEW.project(CORNERS[2])), Request("scale"), snap=ALL)
    assert requested_scaling(state, FRAME, snap=snap).factors == pytest.approx([2.0] * 3)
    locked = requested_scaling(replace(state, axis_lock=AxisLock(0)), FRAME, snap=snap)
    assert locked.factors == pytest.approx([2.0, 1.0, 1.0])


def test_snap_points_are_averaged_and_the_base_is_the_source() -> None:
    snap = snapping("VERTEX", points=np.array([[9.0, 9, 9]]))
    pixel = VIEW.project(CORNERS[2])
    chosen = {"snap_points": (tuple(CORNERS[0]),), "base": (0.5, 0.0, 0.0)}
    np.testing.assert_allclose(moved(pixel, snap, **chosen), (0.5, 1.0, 1.0), atol=1e-6)
    np.testing.assert_allclose(moved(pixel, snap, picking_base=True), 0.0)


def test_a_base_snaps_to_geometry_where_only_increments_are_chosen() -> None:
    snap = snapping("INCREMENT")
    state = State(Pointer.at((0.0, 0.0)).moved(VIEW.project(CORNERS[1])), snap=MOVES, picking_base=True)
    np.testing.assert_allclose(snap.target(state, FRAME).position, CORNERS[1])
    assert snap.target(replace(state, picking_base=False), FRAME) is None
    picked = replace(state, picking_base=False, base=(0, 0, 0))
    np.testing.assert_allclose(snap.target(picked, FRAME).position, CORNERS[1])


@pytest.mark.parametrize("element", ["VERTEX", "EDGE", "FACE", "GRID", "VOLUME"])
def test_typed_numbers_do_not_snap(element: str) -> None:
    assert moved((450.0, 300.0), snapping(element), typed=typed("0.3"))[0] == 0.3


@pytest.mark.parametrize("element", ["FACE", "VERTEX", "EDGE", "GRID"])
def test_a_move_is_aligned_with_the_normal_of_a_face_a_vertex_or_the_grid_or_along_an_edge(element: str) -> None:
    pixel = VIEW.project(CORNERS[0] if element == "VERTEX" else (CORNERS[0] + CORNERS[1]) / 2)
    snap, state = snapping(element, align=True), State(Pointer.at((400.0, 300.0)).moved(pixel), ctrl=True)
    found = requested_translation(state, FRAME, snap=snap).alignment
    along = (CORNERS[1] - CORNERS[0]) / np.linalg.norm(CORNERS[1] - CORNERS[0])
    assert found is not None and abs(found[0] @ (along if element == "EDGE" else (0, 0, 1))) == pytest.approx(1)
    for without in (replace(snap, align=False), snapping("INCREMENT", align=True)):
        assert requested_translation(state, FRAME, snap=without).alignment is None
