# SPDX-License-Identifier: GPL-3.0-or-later
"""The minimum distance of the scene and of pairs of bodies, measured by brute force after every edit."""

from __future__ import annotations

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes.primitives import box, grid, icosphere, triangulated
from blend_fixtures.scenes.shape import joined
from tests.oracles.distances import near_pairs

OPTIONS = stiv.EditOptions()
RATIO, RATIO_BETWEEN = OPTIONS.min_clearance_ratio, OPTIONS.min_clearance_ratio_between
SIZES = {("box", "sheet"): 0.05, ("ball", "sheet"): 0.11, ("ball", "box"): 0.02}


def scene(seed: int) -> tuple[stiv.Surface, np.ndarray]:
    """A randomly rotated box and ball side by side above a sheet, with contacts of faces, edges and corners."""
    chance = np.random.default_rng(seed)
    shapes = [
        triangulated(box(1, (0.9, 0.8, 0.7))).turned(chance.normal(size=3)).moved((-0.75, 0.1, 0.9)),
        icosphere(1).turned(chance.normal(size=3)).scaled(0.5).moved((0.75, 0, 0.8)),
        triangulated(grid(7, 7, 4, 4)),
    ]
    whole = joined(shapes)
    owner = np.repeat(np.arange(3), [len(shape.vertices) for shape in shapes])
    bodies = [stiv.Body("box"), stiv.Body("ball"), stiv.Body("sheet")]
    surface = stiv.Surface(whole.triangles(), len(whole.vertices), vertex_body=owner, bodies=bodies)
    return surface, whole.vertices.astype(np.float32).astype(float)


def separations(surface: stiv.Surface, of_scene: float, pairs: dict[tuple[str, str], float]) -> np.ndarray:
    """(B, B), by bodies."""
    numbers = {body.name: number for number, body in enumerate(surface.bodies)}
    table = np.full((len(numbers),) * 2, of_scene)
    for (a, b), h in pairs.items():
        table[numbers[a], numbers[b]] = table[numbers[b], numbers[a]] = h
    return table


def check_distances(surface: stiv.Surface, table: np.ndarray, begin: np.ndarray, end: np.ndarray) -> None:
    """Pairs that started at least h apart stay so; others preserve the required fraction of their distance."""
    body, reach = surface.vertex_body, float(table.max())
    begun, ended = near_pairs(surface, begin, 1.01 * reach), near_pairs(surface, end, reach)
    for pair, distance in ended.items():
        h = table[body[pair[1]], body[pair[4]]]
        start = begun.get(pair, np.inf)
        if start >= h:
            assert distance >= h * (1 - 1e-6), (pair, start, distance, h)
        else:
            share = RATIO if body[pair[1]] == body[pair[4]] else RATIO_BETWEEN
            assert distance >= start * share * (1 - 1e-6), (pair, start, distance)


@pytest.mark.parametrize("pairs", [{}, SIZES], ids=["scene", "pairs"])
@pytest.mark.parametrize("seed", range(6))
def test_pairs_that_start_apart_respect_their_separation(seed: int, pairs: dict[tuple[str, str], float]) -> None:
    surface, start = scene(seed)
    options = stiv.EditOptions(separation=0.03, pair_separations=pairs)
    session = stiv.EditSession(surface, stiv.identity(len(start)), start, options)
    table = separations(surface, 0.03, pairs)
    chance = np.random.default_rng(seed)
    pushes = [(0, (0, 0, -0.8)), (1, (0, 0, -0.8)), (0, (0.9, 0, 0)), (1, chance.normal(size=3)), (2, (0, 0, 1.0))]
    touched = 0
    for body, push in pushes:
        goal = session.controls + np.where(surface.vertex_body[:, None] == body, push, 0.0)
        result = session.edit(goal)
        touched += len(result.events)
        check_distances(surface, table, start, result.surface)
    assert touched > 0
    assert session.least_distance().distance >= table.min() * (1 - 1e-6)


def test_a_larger_separation_of_a_pair_applies_only_to_that_pair() -> None:
    surface, start = scene(1)
    goal = start - np.where(surface.vertex_body[:, None] < 2, (0, 0, 1.0), 0.0)
    weights = np.where(surface.vertex_body < 2, 1.0, 0.0)
    options = stiv.EditOptions(separation=0.01, pair_separations={("sheet", "ball"): 0.2}, weights=weights)
    result = stiv.edit(surface, stiv.identity(len(start)), start, goal, options)
    heights = [result.surface[surface.vertex_body == body, 2].min() for body in (0, 1)]
    assert 0.01 * (1 - 1e-6) <= heights[0] <= 0.03
    assert 0.2 * (1 - 1e-6) <= heights[1] <= 0.45


def test_pairs_closer_than_the_separation_at_the_start_do_not_jump() -> None:
    surface, start = scene(2)
    low = start.copy()
    low[surface.vertex_body == 0, 2] -= start[surface.vertex_body == 0, 2].min() - 0.01
    options = stiv.EditOptions(separation=0.05)
    session = stiv.EditSession(surface, stiv.identity(len(low)), low, options)
    goal = session.controls + np.where(surface.vertex_body[:, None] == 1, (0, 0, 0.3), 0.0)
    assert session.edit(goal).status == "reached"
    assert session.controls[surface.vertex_body == 0] == pytest.approx(low[surface.vertex_body == 0], abs=1e-7)
    before = session.surface
    result = session.edit(session.controls - np.where(surface.vertex_body[:, None] == 0, (0, 0, 0.2), 0.0))
    check_distances(surface, np.full((3, 3), 0.05), low, result.surface)
    moved = (result.surface - before)[surface.vertex_body == 0]
    assert np.linalg.norm(moved, axis=1).max() < 0.3


@pytest.mark.parametrize("how", ["edit", "drag"])
@pytest.mark.parametrize("seed", range(3))
def test_pairs_that_start_closer_do_not_creep_together_and_can_return(seed: int, how: str) -> None:
    """Many edits press the box against the sheet, which it starts closer to than the separation."""
    surface, start = scene(seed)
    low = start.copy()
    low[surface.vertex_body == 0, 2] -= start[surface.vertex_body == 0, 2].min() - 0.02
    low = low.astype(np.float32).astype(float)
    session = stiv.EditSession(surface, stiv.identity(len(low)), low, stiv.EditOptions(separation=0.05))
    chance = np.random.default_rng(seed)
    goal, table = session.controls, np.full((3, 3), 0.05)
    for _ in range(12):
        push = np.append(chance.normal(scale=0.05, size=2), -0.1)
        goal = goal + np.where(surface.vertex_body[:, None] == 0, push, 0.0)
        result = getattr(session, how)(goal)
        check_distances(surface, table, low, result.surface)
    session.edit(low)
    session.settle()
    assert np.abs(session.surface - low).max() < 0.01  # no pair is pushed further apart than it was


@pytest.mark.parametrize("gap", [0.01, 0.04])
def test_an_edit_elsewhere_does_not_move_close_pairs(gap: float) -> None:
    surface, start = scene(1)
    start[surface.vertex_body == 0, 2] -= start[surface.vertex_body == 0, 2].min() - gap
    start = start.astype(np.float32).astype(float)
    session = stiv.EditSession(surface, stiv.identity(len(start)), start, stiv.EditOptions(separation=0.3))
    goal = start + np.where(surface.vertex_body[:, None] == 1, (0.2, 0.3, 0.4), 0.0)
    result = session.edit(goal)
    still = surface.vertex_body != 1
    assert np.abs(result.surface - start)[still].max() < 1e-6


def test_impossible_separations_and_unknown_bodies_are_refused() -> None:
    surface, start = scene(0)
    for pairs, message in [
        ({("box", "lid"): 0.1}, "0 bodies"),
        ({(0, 3): 0.1}, "no body 3"),
        ({("box", "ball"): 0.0}, "least that can be kept"),
        ({("box", "ball"): np.inf}, "separation"),
    ]:
        with pytest.raises(stiv.InputError, match=message):
            stiv.EditSession(surface, stiv.identity(len(start)), start, stiv.EditOptions(pair_separations=pairs))
