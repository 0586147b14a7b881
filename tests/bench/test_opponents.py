# SPDX-License-Identifier: GPL-3.0-or-later
"""Comparisons outside the table: fractions of motion, cost of detection, models from a folder."""

import types

import numpy as np
import pytest

import stiv
from benchmarks.sessions.cloth import kept
from benchmarks.sessions.models import largest_part
from benchmarks.sessions.peer_mesh import LinearStep, culled, moving_first, settings_of
from benchmarks.sessions.race import with_detection
from blend_fixtures.scenes.detection_steps import knot, local_edit
from blend_fixtures.scenes.primitives import box, icosphere, triangulated
from blend_fixtures.scenes.sessions import real_models
from blend_fixtures.scenes.shape import joined
from stiv.command_line import program


def test_the_share_of_motion_kept_is_one_at_the_goal_and_none_at_the_start():
    start, wanted = np.zeros((4, 3)), np.ones((4, 3))
    assert (kept(start, wanted, wanted), kept(start, wanted, start)) == (1.0, 0.0)
    assert kept(start, wanted, 0.25 * wanted) == pytest.approx(0.25)


def test_an_edit_with_other_detections_costs_the_rest_and_each_of_them():
    mine = types.SimpleNamespace(processor=10.0, detections=3, timings={"detection": 8.0, "total": 16.0})
    assert with_detection(mine, 2.0) == pytest.approx(5.0 + 6.0)


def test_the_largest_part_of_a_mesh_is_that_with_the_most_vertices():
    small, large = icosphere(1), icosphere(2).moved((5, 0, 0))
    both = joined([small, large, small.moved((9, 0, 0))])
    positions, triangles = largest_part(both.vertices, both.triangles())
    assert np.array_equal(positions, large.vertices) and np.array_equal(triangles, large.triangles())


def test_an_animal_starts_just_before_its_first_contact_with_the_teapot():
    animal, room = triangulated(box(2)), icosphere(3, 0.6).moved(real_models.ROOM)
    stage = next(real_models.animal_in_teapot(animal, room).stages())
    start = stage.deformation.surface(stage.controls)
    assert len(stiv.find_intersections(start, stage.surface)) == 0
    moves = stage.surface.vertex_body == 0
    bigger = np.where(moves[:, None], real_models.ROOM + 1.05 * (start - real_models.ROOM), start)
    assert len(stiv.find_intersections(bigger, stage.surface)) > 0
    assert np.ptp(start[moves], axis=0).max() < np.ptp(start[~moves], axis=0).max()


def test_a_figure_is_turned_upright():
    lying = icosphere(1).scaled((1, 3, 0.5)).moved((0, 7, 0))  # 6 high along y
    found = real_models.upright(lying).vertices
    assert np.ptp(found, axis=0) == pytest.approx(np.ptp(lying.vertices, axis=0)[[0, 2, 1]] * real_models.HEIGHT / 6)
    assert found[:, 2].min() == 0


def test_models_that_are_absent_are_left_out_and_named(tmp_path, capsys):
    (tmp_path / "teapot.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert program.run(["bench", "--models", str(tmp_path)]) == 0
    said = capsys.readouterr().err
    assert "has no stanford-bunny.obj" in said and "has no ogre.obj" in said


@pytest.mark.parametrize(
    "arguments", [[], ["models"], ["race", "--models", "."], ["--models", "there is no such folder"]]
)
def test_models_need_their_folder_and_nothing_else_takes_one(arguments):
    assert program.run(["bench", *arguments]) == 2


def test_the_culled_mesh_contains_every_contact():
    whole = local_edit()
    step = LinearStep(whole.triangles, whole.start, whole.end)
    less = moving_first(culled(step))
    count = int(step.moves.sum())
    assert settings_of(step) == ("everything", "filter", "culled")
    assert less.moves[:count].all() and not less.moves[count:].any()
    assert len(less.triangles) < len(step.triangles) / 10
    times = [np.sort(stiv.Detector(s.triangles).find(s.start, s.end).time) for s in (step, less)]
    assert len(times[0]) > 100 and np.array_equal(times[0], times[1])


def test_where_everything_moves_the_peer_can_leave_nothing_out():
    step = knot()
    assert settings_of(LinearStep(step.triangles, step.start, step.end)) == ("everything",)
