# SPDX-License-Identifier: GPL-3.0-or-later
"""Tight edits end closer to their goals, at optima that other methods find."""

from __future__ import annotations

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes import families
from blend_fixtures.scenes.primitives import box, grid, icosphere, triangulated
from blend_fixtures.scenes.shape import Shape


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


FLOOR = -0.5
CLEARANCE = 1e-6


def turned(vectors: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Vectors turned by a rotation vector (Rodrigues' formula)."""
    angle = np.linalg.norm(turn)
    axis = turn / angle
    along = (vectors @ axis)[:, None] * axis
    return np.asarray(along + np.cos(angle) * (vectors - along) + np.sin(angle) * np.cross(axis, vectors))


def least_energy_of_turns(vertices: np.ndarray, start: np.ndarray, target: np.ndarray) -> float:
    """The least energy of a rigid body whose vertices stay above the floor: a smooth program over six numbers.

    The solver starts at rigid controls, whose rotation is not 0, and at turns nearby.
    """
    optimize = pytest.importorskip("scipy.optimize")  # Pythons of other platforms lack it
    arms = vertices - vertices.mean(axis=0)

    def placed(x: np.ndarray) -> np.ndarray:
        return np.asarray(x[:3] + turned(arms, x[3:]))

    def energy(x: np.ndarray) -> float:
        return 0.5 * float(((placed(x) - target) ** 2).sum())

    def height(x: np.ndarray) -> np.ndarray:
        return np.asarray(placed(x)[:, 2] - FLOOR - CLEARANCE)

    def solved(turn: np.ndarray) -> float:
        above = {"type": "ineq", "fun": height}
        found = optimize.minimize(
            energy, np.r_[start[0], turn], method="SLSQP", constraints=above, options={"ftol": 1e-14, "maxiter": 300}
        )
        found.x[2] -= min(0.0, height(found.x).min())
        return energy(found.x)

    chance = np.random.default_rng(0)
    return min(solved(start[1] + size * chance.normal(size=3)) for size in (0, 0.1, 0.2, 0.4))


SHAPES = {
    "egg": Shape(icosphere(2, 0.3).vertices * (1.6, 1, 0.7), icosphere(2).faces),
    "box": box(3, (0.8, 0.5, 0.3)),
    "wedge": Shape(
        np.array(
            [(-0.4, -0.3, -0.2), (-0.4, 0.3, -0.2), (0.4, -0.3, -0.2), (0.4, 0.3, -0.2), (0, -0.3, 0.2), (0, 0.3, 0.2)]
        ),
        ((0, 1, 3, 2), (0, 2, 4), (1, 5, 3), (0, 4, 5, 1), (2, 3, 5, 4)),
    ),
}


@pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
def test_a_tight_edit_turns_a_rigid_body_as_far_as_its_floor_allows(shape: Shape) -> None:
    body, floor = triangulated(shape), triangulated(grid(6, 6, 6, 6)).moved((0, 0, FLOOR))
    count = len(body.vertices)
    triangles = np.vstack([body.triangles(), floor.triangles() + count])
    bodies = [stiv.Body("Body", "rigid"), stiv.Body("Floor", "fixed")]
    owner = np.repeat([0, 1], [count, len(floor.vertices)])
    surface = stiv.Surface(triangles, vertex_count=len(owner), vertex_body=owner, bodies=bodies)
    whole = np.vstack([body.vertices, floor.vertices])
    deformation = stiv.concatenate([(stiv.rigid(body.vertices), np.arange(count))], whole)
    rest = stiv.rigid_rest_controls(body.vertices)
    goal = rest + np.array([(0.1, 0.0, -0.6), (-0.7, 1.0, 0.2)])
    options = stiv.EditOptions(tight=True, separation=CLEARANCE, threads=1)
    tight = stiv.edit(surface, deformation, rest, goal, options)
    least = least_energy_of_turns(body.vertices, tight.controls, stiv.rigid(body.vertices).surface(goal))
    assert tight.energy == pytest.approx(least, rel=1e-4)
    assert len(stiv.find_intersections(tight.surface, surface)) == 0


@pytest.mark.parametrize("edit", [families.sheets(0.5), families.rigid(0.7), families.knot(0.5)], ids=lambda e: e.name)
def test_a_tight_edit_never_ends_further_from_its_goal(edit: families.Edit) -> None:
    session = stiv.EditSession(edit.surface, edit.deformation, edit.controls, stiv.EditOptions(tight=True, threads=1))
    smooth = stiv.EditSession(edit.surface, edit.deformation, edit.controls, stiv.EditOptions(threads=1))
    tight = session.edit(edit.goal)
    assert tight.energy <= smooth.edit(edit.goal).energy
    assert len(stiv.find_intersections(tight.surface, edit.surface)) == 0
    assert not session.settle().path
