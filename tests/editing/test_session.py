# SPDX-License-Identifier: GPL-3.0-or-later
"""Sessions in scripts: progress, cancellation, concurrent calls, bad input."""

from __future__ import annotations

import threading
from dataclasses import fields

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes import families
from stiv.edit_options import native_options


@pytest.fixture
def edit() -> families.Edit:
    """Two sheets, one pushed through the other."""
    return families.sheets(0.4, cells=8)


@pytest.fixture
def session(edit: families.Edit) -> stiv.EditSession:
    return stiv.EditSession(edit.surface, edit.deformation, edit.controls)


def test_bare_triangles_make_a_surface() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, 1], [0.4, 0.2, 1], [0.2, 0.4, 1]], float)
    goal = points.copy()
    goal[3:, 2] = -1
    result = stiv.edit([[0, 1, 2], [3, 4, 5]], stiv.identity(6), points, goal)
    assert result.status == "reached"  # around the other sheet; the second sub-edit finds this path
    assert result.rounds == result.counters["rounds"] > 0
    assert set(result.timings) == {"deformation", "detection", "volumes", "response", "acceptance", "total"}
    assert len(result.events) > 0
    assert result.patches >= 1


def test_progress_is_called_and_its_exception_propagates(session: stiv.EditSession, edit: families.Edit) -> None:
    calls: list[tuple[str, float]] = []

    def fail_later(phase: str, fraction: float) -> None:
        calls.append((phase, fraction))
        if len(calls) == 2:
            raise KeyError("from the callback")

    with pytest.raises(KeyError, match="from the callback"):
        session.edit(edit.goal, progress=fail_later)
    assert len(calls) == 2
    assert all(0 <= fraction <= 1 for _, fraction in calls)
    assert np.array_equal(session.controls, edit.controls)
    assert session.edit(edit.goal).status == "corrected"


def test_weights_change_within_a_session(session: stiv.EditSession, edit: families.Edit) -> None:
    """As in a new session with these weights that begins at the accepted state."""
    half = (edit.controls + edit.goal) / 2
    session.drag(half)
    accepted = session.controls
    axes = np.broadcast_to(np.linalg.qr([[1.0, 2, 0], [0, 1, 1], [1, 0, 3]])[0], (len(accepted), 3, 3))
    weights = np.ones((len(accepted), 3)) * [1, 0, 0.5]
    options = stiv.EditOptions(weights=weights, weight_axes=axes)
    other = stiv.EditSession(edit.surface, edit.deformation, edit.controls, options)
    other.restore(accepted, half)
    session.set_weights(weights, axes)
    assert np.array_equal(session.controls, accepted)
    assert np.array_equal(session.drag(edit.goal).controls, other.drag(edit.goal).controls)
    assert not np.array_equal(session.controls, accepted)
    for bad, message in ((np.ones(3), "3 entries for"), (-weights, "not negative"), (np.ones((3, 2)), "shape")):
        with pytest.raises(stiv.InputError, match=message):
            session.set_weights(bad)
    session.set_weights(None)
    session.restore(edit.controls)
    fresh = stiv.EditSession(edit.surface, edit.deformation, edit.controls)
    assert np.array_equal(session.edit(edit.goal).controls, fresh.edit(edit.goal).controls)


def test_cancelling_restores_the_previous_state(session: stiv.EditSession, edit: families.Edit) -> None:
    token = stiv.CancelToken()
    result = session.edit(edit.goal, cancel=token, progress=lambda phase, fraction: token.cancel())
    assert result.status == "cancelled"
    assert np.array_equal(result.controls, edit.controls)


def test_a_second_call_on_a_session_in_use_is_refused(session: stiv.EditSession, edit: families.Edit) -> None:
    refused: list[Exception] = []

    def call_again(phase: str, fraction: float) -> None:
        def work() -> None:
            try:
                session.settle()
            except stiv.InputError as error:
                refused.append(error)

        other = threading.Thread(target=work)
        other.start()
        other.join()

    assert session.edit(edit.goal, progress=call_again).status == "corrected"
    assert "in use" in str(refused[0])


def test_the_time_budget_returns_an_accepted_state(edit: families.Edit) -> None:
    session = stiv.EditSession(edit.surface, edit.deformation, edit.controls, stiv.EditOptions(time_budget=1e-9))
    result = session.edit(edit.goal)
    assert result.status == "budget"
    assert len(stiv.find_intersections(result.surface, edit.surface)) == 0


def test_all_pinned_is_blocked_and_names_the_bodies(edit: families.Edit) -> None:
    options = stiv.EditOptions(weights=np.zeros(len(edit.controls)))
    result = stiv.edit(edit.surface, edit.deformation, edit.controls, edit.goal, options)
    assert result.status == "blocked"
    assert set(result.blocking) == {body.name for body in edit.surface.bodies}
    assert len(stiv.find_intersections(result.surface, edit.surface)) == 0


def test_bodies_of_one_name_are_named_once() -> None:
    sheet = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float)
    start = np.vstack([sheet, sheet + (0, 0, 0.3)])
    bodies = [stiv.Body("Cube"), stiv.Body("Cube")]
    surface = stiv.Surface([[0, 1, 2], [3, 4, 5]], 6, vertex_body=[0, 0, 0, 1, 1, 1], bodies=bodies)
    goal = start - np.repeat([0, 0.5], 3)[:, None] * (0, 0, 1)
    result = stiv.edit(surface, stiv.identity(6), start, goal, stiv.EditOptions(weights=np.zeros(6)))
    assert (result.status, result.blocking) == ("blocked", ("Cube",))


def test_restore_undoes_edits(session: stiv.EditSession, edit: families.Edit) -> None:
    start = session.controls
    session.edit(edit.goal)
    session.restore(start)
    assert np.array_equal(session.controls, start)


def test_a_start_that_intersects_is_refused_with_its_pairs(edit: families.Edit) -> None:
    with pytest.raises(stiv.StartIntersectsError, match="already intersects") as caught:
        stiv.EditSession(edit.surface, edit.deformation, edit.controls * (1, 1, 0))
    assert caught.value.pairs.shape[1] == 2


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"separation": 1e-12}, "the least that can be kept"),
        ({"separation": -1.0}, "the least that can be kept"),
        ({"min_clearance_ratio": 1.0}, "min_clearance_ratio"),
        ({"smoothness": 0.0}, "smoothness"),
        ({"weights": [1.0, 2.0]}, "weights has 2 entries"),
        ({"weights": np.ones((4, 2))}, r"weights: shape is \(4, 2\), expected \(m,\) or \(m, 3\)"),
        ({"weight_axes": np.ones((4, 3))}, r"weight_axes: shape is \(4, 3\), expected \(m, 3, 3\)"),
        ({"constraints": "many"}, "constraints"),
        ({"broad_phase": "magic"}, "broad_phase"),
        ({"max_rounds": "ten"}, "max_rounds"),
        ({"storage": [stiv.StorageFrame(0, 10**6)]}, "storage frame 0"),
        ({"storage": [stiv.StorageFrame(0, 1, np.diag([1.0, 1.0, 0.0, 1.0]))]}, "storage frame 0"),
    ],
)
def test_bad_options_are_named(edit: families.Edit, options: dict[str, object], message: str) -> None:
    with pytest.raises(stiv.InputError, match=message):
        stiv.EditSession(edit.surface, edit.deformation, edit.controls, stiv.EditOptions(**options))


@pytest.mark.parametrize("goal", [np.zeros((3, 3)), np.zeros(12), np.zeros((4, 2)), [["a"] * 3], np.float64(1)])
def test_goals_of_the_wrong_shape_are_refused(session: stiv.EditSession, goal: object) -> None:
    before = session.controls
    with pytest.raises(stiv.InputError):
        session.edit(goal)
    assert np.array_equal(session.controls, before)


def test_a_goal_that_is_not_finite_names_object_and_control(session: stiv.EditSession, edit: families.Edit) -> None:
    goal = edit.goal.copy()
    goal[7, 1] = np.nan
    with pytest.raises(stiv.InputError, match='object "deformable 0", control 7: coordinate is not finite'):
        session.drag(goal)
    assert np.array_equal(session.controls, edit.controls)


def test_an_edit_without_movable_controls_returns_unchanged(edit: families.Edit) -> None:
    nothing = stiv.concatenate([], edit.controls)
    result = stiv.edit(edit.surface, nothing, np.zeros((0, 3)), np.zeros((0, 3)))
    assert result.status == "unchanged"
    assert np.array_equal(result.surface, edit.controls)
    empty = stiv.edit(np.zeros((0, 3), int), stiv.identity(0), np.zeros((0, 3)), np.zeros((0, 3)))
    assert empty.status == "unchanged"


def test_the_representation_shows_the_shape_of_weights() -> None:
    options = stiv.EditOptions(weights=np.ones((5000, 3)), smoothness=0.01)
    assert repr(options) == "EditOptions(smoothness=0.01, weights=<array of shape (5000, 3)>)"
    assert repr(stiv.EditOptions()) == "EditOptions()"
    assert len(repr(stiv.EditOptions(weights=[1.0] * 5000))) < 100


def test_the_defaults_are_those_of_the_core() -> None:
    core, ours = stiv._native.EditOptions(), native_options(stiv.EditOptions())
    for option in fields(stiv.EditOptions):
        assert np.array_equal(getattr(core, option.name), getattr(ours, option.name)), option.name
