# SPDX-License-Identifier: GPL-3.0-or-later
"""The filter of velocities leaves nothing that intersects; the measure of roughness tells rough from smooth."""

import numpy as np
import pytest

import stiv
from benchmarks.velocity_filter import filtered, roughness
from blend_fixtures.scenes.primitives import grid, icosphere, triangulated
from blend_fixtures.scenes.sessions.session import surface_of


def test_a_filtered_ball_stays_above_the_sheet():
    ball = icosphere(2, 0.5).moved((0.03, 0.02, 0.6))
    surface, start = surface_of({"Ball": ball, "Sheet": triangulated(grid(8, 8, 2, 2))}, {"Sheet": "fixed"})
    moves = surface.vertex_body == 0
    goal = start - 0.4 * np.outer(moves, [0, 0, 1])
    end = filtered(surface, start, goal, moves, 1e-3)
    assert len(stiv.find_intersections(goal, surface)) > 0
    assert len(stiv.find_intersections(end, surface)) == 0
    assert (end[~moves] == start[~moves]).all()
    assert (start - end)[moves][:, 2].max() == pytest.approx(0.4)  # the top, which met nothing, came all the way


def test_roughness_of_a_sphere_falls_to_a_quarter_when_edges_are_halved():
    coarse, fine = icosphere(3), icosphere(4)
    first, second = (roughness(ball.vertices, ball.triangles()) for ball in (coarse, fine))
    assert second / first == pytest.approx(0.25, abs=0.05)


def test_a_flat_sheet_has_no_roughness_and_noise_adds_to_it():
    sheet = triangulated(grid(9, 9))
    assert roughness(sheet.vertices, sheet.triangles()) < 1e-12
    noise = 0.02 * np.random.default_rng(1).normal(size=sheet.vertices.shape)
    assert roughness(sheet.vertices + noise, sheet.triangles()) > 0.05
