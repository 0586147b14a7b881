# SPDX-License-Identifier: GPL-3.0-or-later
"""Sessions beside obstacles, compared with the same scenes with the obstacle as a fixed body of the surface."""

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes.primitives import grid, icosphere, triangulated

BALL = icosphere(2, 0.5).moved((0.05, 0.02, 0.9))
FLOOR = triangulated(grid(150, 150, 30, 30))
COUNT = len(BALL.vertices)
BALL_FACES, FLOOR_FACES = (np.array(shape.faces, np.int32) for shape in (BALL, FLOOR))
FACES = np.concatenate([BALL_FACES, FLOOR_FACES + COUNT])
START = np.concatenate([BALL.vertices, FLOOR.vertices])
REST = stiv.rigid_rest_controls(BALL.vertices)


def whole_surface() -> stiv.Surface:
    bodies = [stiv.Body("Ball", "rigid"), stiv.Body("Floor", "fixed")]
    return stiv.Surface(FACES, len(START), vertex_body=np.repeat([0, 1], [COUNT, len(FLOOR.vertices)]), bodies=bodies)


def beside(controls: np.ndarray = REST, **options: object) -> stiv.EditSession:
    """The ball as the surface, the floor as its obstacle."""
    floor = stiv.Obstacle(FLOOR.vertices, FLOOR_FACES, "Floor")
    surface = stiv.Surface(BALL_FACES, COUNT, bodies=[stiv.Body("Ball", "rigid")])
    return stiv.EditSession(surface, stiv.rigid(BALL.vertices), controls, stiv.EditOptions(**options), [floor])


def together(controls: np.ndarray = REST, **options: object) -> stiv.EditSession:
    deformation = stiv.concatenate([(stiv.rigid(BALL.vertices), np.arange(COUNT))], START)
    return stiv.EditSession(whole_surface(), deformation, controls, stiv.EditOptions(**options))


def moved(offset: tuple[float, float, float]) -> np.ndarray:
    return REST + np.array([offset, (0.0, 0.0, 0.0)])


def whole(ball: np.ndarray) -> np.ndarray:
    return np.concatenate([ball, FLOOR.vertices])


def test_a_drag_far_over_the_obstacle_ends_as_with_a_fixed_body() -> None:
    mine, theirs = beside(), together()
    check = stiv.StepCheck(whole_surface())
    before = mine.surface
    touched = 0
    for tick in range(1, 41):
        goal = moved((0.3 * tick, 0.1 * tick, -0.03 * tick))
        result, expected = mine.drag(goal), theirs.drag(goal)
        assert np.allclose(result.controls[0], expected.controls[0], atol=0.05)  # one may lie on another facet
        assert result.energy == pytest.approx(expected.energy, rel=0.02, abs=1e-6)
        for controls in result.path:
            after = stiv.rigid(BALL.vertices).surface(controls)
            assert check.is_free(whole(before), whole(after))
            before = after
        touched += len(result.events) > 0
    assert touched > 10 and mine.controls[0, 0] > 10


def test_a_drag_that_hands_over_its_first_states_stays_free_and_ends_alike() -> None:
    """As the add-on drags while the mouse moves; the last calls follow the same goal to the end."""
    mine, theirs = beside(), together()
    check = stiv.StepCheck(whole_surface())
    before, statuses = mine.surface, set()
    for tick in range(1, 41):
        goal = moved((0.2 * tick, 0.05 * tick, -0.04 * tick))
        result = mine.drag(goal, hand_over=0.0)
        statuses.add(result.status)
        for controls in result.path:
            after = stiv.rigid(BALL.vertices).surface(controls)
            assert check.is_free(whole(before), whole(after))
            before = after
    assert "budget" in statuses
    for session in (mine, theirs):
        while session.drag(goal).status == "budget":
            pass
    assert mine.settle().energy == pytest.approx(theirs.settle().energy, rel=0.02)


@pytest.mark.parametrize("threads", [1, 2])
def test_a_drag_that_was_ended_continues_alike(threads: int) -> None:
    """The session of the next box, which a drag prepares, is only made earlier than otherwise."""
    mine, theirs = beside(threads=threads), beside(threads=threads)
    for tick in range(1, 21):
        goal = moved((0.3 * tick, 0.1 * tick, -0.03 * tick))
        result, expected = mine.drag(goal), theirs.drag(goal)
        mine.end_drag()
        assert np.array_equal(result.controls, expected.controls) and result.status == expected.status


def test_events_and_bodies_are_numbered_as_if_obstacles_followed_the_surface() -> None:
    session = beside()
    session.drag(moved((4.0, 3.0, 0.0)))
    result = session.drag(moved((4.0, 3.0, -0.6)))
    vertices = np.unique(result.events.vertices)
    floor = vertices[vertices >= COUNT] - COUNT
    assert len(floor) > 0
    assert np.abs(FLOOR.vertices[floor, :2] - session.controls[0, :2]).max() < 1  # below the ball
    assert set(result.blocking) <= {"Ball", "Floor"}


@pytest.mark.parametrize("height", [0.0, 2.0, 9.0])
def test_the_least_distance_counts_obstacles_outside_of_the_box(height: float) -> None:
    mine, theirs = beside(), together()
    for session in (mine, theirs):
        session.drag(moved((2.0, 0.0, height)))
    found, expected = mine.least_distance(), theirs.least_distance()
    assert found is not None and expected is not None
    assert found.distance == pytest.approx(expected.distance, rel=1e-5)
    assert found.bodies == expected.bodies == ("Ball", "Floor")
    assert found.triangles[1] >= len(BALL_FACES)


def test_a_start_that_intersects_is_refused_with_the_same_message_and_pairs() -> None:
    inside = moved((3.0, 1.0, -0.7))
    errors = []
    for open_session in (beside, together):
        with pytest.raises(stiv.StartIntersectsError) as refused:
            open_session(inside)
        errors.append(refused.value)
    assert str(errors[0]) == str(errors[1])
    assert np.array_equal(errors[0].pairs, errors[1].pairs)


def test_restoring_a_state_far_away_tests_it_against_the_obstacle_there() -> None:
    session = beside()
    session.restore(moved((8.0, 8.0, 0.0)))
    assert np.allclose(session.controls[0], moved((8.0, 8.0, 0.0))[0])
    with pytest.raises(stiv.StartIntersectsError):
        session.restore(moved((-8.0, 2.0, -0.8)))
    assert np.allclose(session.controls[0], moved((8.0, 8.0, 0.0))[0])
    assert session.drag(moved((8.0, 8.0, -1.0))).surface[:, 2].min() > 0


def test_steps_of_the_surface_are_tested_against_the_obstacle_near_and_far() -> None:
    session = beside()
    for x in (0.0, 9.0):
        above, below = BALL.vertices + (x, 0, 0), BALL.vertices + (x, 0, -3.0)
        assert session.is_step_free(above, above + (0.5, 0, 0))
        assert not session.is_step_free(above, below)


def test_pair_separations_name_obstacles() -> None:
    session = beside(pair_separations={("Ball", "Floor"): 0.1})
    assert session.edit(moved((0.0, 0.0, -1.0))).surface[:, 2].min() > 0.099


def test_weights_and_settling_continue_after_the_box_has_changed() -> None:
    session = beside()
    session.drag(moved((6.0, 0.0, -0.5)))
    session.set_weights([1.0, 0.0])
    result = session.settle()
    assert result.status != "cancelled" and result.surface[:, 2].min() > 0
    assert session.start_drag(moved((-6.0, 0.0, -0.5))).result().surface[:, 2].min() > 0


def test_obstacles_far_from_the_motion_are_not_read() -> None:
    far = stiv.Obstacle(FLOOR.vertices + (0, 0, 500), FLOOR_FACES, "Sky")
    surface = stiv.Surface(BALL_FACES, COUNT, bodies=[stiv.Body("Ball", "rigid")])
    session = stiv.EditSession(surface, stiv.rigid(BALL.vertices), REST, obstacles=[far])
    assert session.edit(moved((1.0, 0.0, -5.0))).status == "reached"
    assert session.edit(moved((0.0, 0.0, 600.0))).surface[:, 2].max() < 500


def test_obstacles_refuse_bad_input() -> None:
    with pytest.raises(stiv.InputError, match='object "Rock", vertex 1: coordinate is not finite'):
        stiv.Obstacle([[0, 0, 0], [np.nan, 0, 0]], np.zeros((0, 3), np.int32), "Rock")
    with pytest.raises(stiv.InputError, match='object "Rock", face 0: vertex index 2 is out of range'):
        stiv.Obstacle([[0, 0, 0], [1, 0, 0]], [[0, 1, 2]], "Rock")
