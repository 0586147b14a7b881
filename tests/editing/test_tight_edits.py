# SPDX-License-Identifier: GPL-3.0-or-later
"""Tight edits end closer to their goals, at optima that other methods find."""

from __future__ import annotations

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes import families
from blend_fixtures.scenes.primitives import grid, icosphere, triangulated


def lattice_over_plate(depth: float) -> tuple[stiv.Surface, stiv.Deformation, np.ndarray, np.ndarray, np.ndarray]:
    """A ball in a lattice above a plate at height 0: surface, deformation, controls, goal, and the ball's rows."""
    ball, plate = triangulated(icosphere(2, 0.4)).moved((0.02, 0.03, 0.6)), triangulated(grid(6, 6, 6, 6))
    vertices = np.vstack([ball.vertices, plate.vertices])
    rows = np.arange(len(ball.vertices))
    triangles = np.vstack([ball.triangles(), plate.triangles() + len(rows)])
    bodies = [stiv.Body("Ball", "deformable"), stiv.Body("Plate", "fixed")]
    owner = np.repeat([0, 1], [len(rows), len(plate.vertices)])
    surface = stiv.Surface(triangles, vertex_count=len(vertices), vertex_body=owner, bodies=bodies)
    resolution = (3, 3, 3)
    frame = np.diag([0.45, 0.45, 0.45, 1.0])
    frame[:3, 3] = (0.02, 0.03, 0.6)
    points = stiv.lattice_rest_points(resolution) @ frame[:3, :3].T + frame[:3, 3]
    deformation = stiv.concatenate([(stiv.lattice(ball.vertices, resolution, frame=frame), rows)], vertices)
    return surface, deformation, points, points - (0, 0, depth), rows


def least_energy(deformation: stiv.Deformation, controls: np.ndarray, goal: np.ndarray, rows: np.ndarray) -> float:
    """The least energy above the plate: the dual of a quadratic program over the heights, by sweeps."""
    rest = deformation.surface(controls)
    columns = []
    for k in range(len(controls)):
        moved = controls.copy()
        moved[k, 2] += 1
        columns.append((deformation.surface(moved) - rest)[rows, 2])
    weights = np.array(columns).T
    steps = np.linalg.pinv(weights)
    pushes = weights @ steps  # a projection: the controls span all heights that the ball can have
    excess = deformation.surface(goal)[rows, 2].copy()
    multipliers = np.zeros(len(excess))
    for _ in range(4000):
        for r in np.flatnonzero((excess < 0) | (multipliers > 0)):
            change = max(-multipliers[r], -excess[r] / pushes[r, r])
            multipliers[r] += change
            excess += change * pushes[:, r]
    return float(0.5 * multipliers @ pushes @ multipliers)


@pytest.mark.parametrize("depth", [0.5, 0.9])
def test_a_tight_edit_of_a_lattice_ends_at_the_optimum_of_a_quadratic_program(depth: float) -> None:
    surface, deformation, controls, goal, rows = lattice_over_plate(depth)
    smooth, tight = (
        stiv.edit(surface, deformation, controls, goal, stiv.EditOptions(tight=tight, separation=1e-6, threads=1))
        for tight in (False, True)
    )
    least = least_energy(deformation, controls, goal, rows)
    assert tight.energy < smooth.energy
    assert tight.energy == pytest.approx(least, rel=2e-4)
    assert len(stiv.find_intersections(tight.surface, surface)) == 0


def least_energy_of_turns(vertices: np.ndarray, goal: np.ndarray, floor: float) -> float:
    """The least energy of a rigid body above a floor, by random changes of its rotation.

    Each rotation has one best translation: that to the goal, lifted until the lowest vertex is above the floor.
    """
    rigid = stiv.rigid(vertices)
    target = rigid.surface(goal)

    def energy(turn: np.ndarray) -> float:
        turned = rigid.surface(np.array([goal[0], turn]))
        lift = (target - turned).mean(axis=0)
        lift[2] = max(lift[2], floor - turned[:, 2].min())
        return float(0.5 * ((turned + lift - target) ** 2).sum())

    def descend(chance: np.random.Generator) -> float:
        turn, least, scale = goal[1], energy(goal[1]), 0.3
        while scale > 1e-6:
            for other in turn + scale * chance.normal(size=(30, 3)):
                if energy(other) < least:
                    turn, least = other, energy(other)
                    break
            else:
                scale *= 0.7
        return least

    return min(descend(np.random.default_rng(seed)) for seed in range(6))


def test_a_tight_edit_turns_a_rigid_body_as_far_as_its_floor_allows() -> None:
    ball, floor = icosphere(2, 0.3), triangulated(grid(6, 6, 6, 6)).moved((0, 0, -0.5))
    vertices = ball.vertices * (1.6, 1, 0.7)
    count = len(vertices)
    triangles = np.vstack([triangulated(ball).triangles(), floor.triangles() + count])
    bodies = [stiv.Body("Egg", "rigid"), stiv.Body("Floor", "fixed")]
    owner = np.repeat([0, 1], [count, len(floor.vertices)])
    surface = stiv.Surface(triangles, vertex_count=len(owner), vertex_body=owner, bodies=bodies)
    whole = np.vstack([vertices, floor.vertices])
    deformation = stiv.concatenate([(stiv.rigid(vertices), np.arange(count))], whole)
    rest = stiv.rigid_rest_controls(vertices)
    goal = rest + np.array([(0.1, 0.0, -0.6), (0.1, 1.5, 0.2)])
    options = stiv.EditOptions(tight=True, separation=1e-6, threads=1)
    tight = stiv.edit(surface, deformation, rest, goal, options)
    assert tight.energy == pytest.approx(least_energy_of_turns(vertices, goal, -0.5), rel=5e-3)
    assert len(stiv.find_intersections(tight.surface, surface)) == 0


@pytest.mark.parametrize("edit", [families.sheets(0.5), families.rigid(0.7), families.knot(0.5)], ids=lambda e: e.name)
def test_a_tight_edit_never_ends_further_from_its_goal(edit: families.Edit) -> None:
    session = stiv.EditSession(edit.surface, edit.deformation, edit.controls, stiv.EditOptions(tight=True, threads=1))
    smooth = stiv.EditSession(edit.surface, edit.deformation, edit.controls, stiv.EditOptions(threads=1))
    tight = session.edit(edit.goal)
    assert tight.energy <= smooth.edit(edit.goal).energy
    assert len(stiv.find_intersections(tight.surface, edit.surface)) == 0
    assert not session.settle().path
