# SPDX-License-Identifier: GPL-3.0-or-later
"""Edits of the scene families: clear results, clear paths, and close to the goal."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import stiv
from benchmarks.energy import truncated_energy
from blend_fixtures.scenes import families
from blend_fixtures.scenes.families import Edit

# One edit of each family, and the largest energy that it may leave, relative to a stop at the first contact:
# the measured value plus at most a fifth.
CASES = [
    (families.spheres(1.0), 0.031),
    (families.sheets(0.4), 0.155),
    (families.fold(), 0.165),
    (families.subdivision(0.6, levels=2), 0.10),
    (families.loop(0.6), 0.067),
    (families.vase(1.8, count=6), 0.0006),
    (families.rigid(1.0), 0.58),
    (families.bulge(0.8), 0.50),
    (families.bulge(0.8, cells=10, rigid=True), 0.58),
    (families.loop_by_handles(0.6), 0.1),
    (families.knot(0.5, rings=90, sides=6), 0.017),
]
IDS = [edit.name for edit, _ in CASES]


def session_of(edit: Edit, **options: object) -> stiv.EditSession:
    """A session with the edit's own options and additional ones."""
    chosen = stiv.EditOptions(**{**edit.options, **options})
    return stiv.EditSession(edit.surface, edit.deformation, edit.controls, chosen)


def path_is_free(edit: Edit, start: np.ndarray, result: stiv.EditResult, samples: int = 60) -> bool:
    """No pair of triangles intersects at any of many sampled times, found without a continuous test."""
    states = [start, *(edit.deformation.surface(controls) for controls in result.path)]
    assert np.array_equal(states[-1], result.surface)
    return all(
        len(stiv.find_intersections(begin + t * (end - begin), edit.surface)) == 0
        for begin, end in pairwise(states)
        for t in np.linspace(0, 1, samples)
    )


@pytest.mark.parametrize(("edit", "share"), CASES, ids=IDS)
def test_an_edit_is_clear_and_close_to_the_goal(edit: Edit, share: float) -> None:
    session = session_of(edit)
    start = session.surface
    result = session.edit(edit.goal)
    assert result.status in ("reached", "corrected")
    assert len(stiv.find_intersections(result.surface, edit.surface)) == 0
    assert path_is_free(edit, start, result)
    assert np.array_equal(result.controls, result.controls.astype(np.float32))
    goal = edit.deformation.surface(edit.goal)
    assert result.energy == pytest.approx(0.5 * ((result.surface - goal) ** 2).sum())
    assert result.energy <= share * truncated_energy(edit, session.separation)
    settled = session.settle()
    assert settled.energy <= result.energy
    assert len(stiv.find_intersections(settled.surface, edit.surface)) == 0


@pytest.mark.parametrize(("edit", "share"), CASES, ids=IDS)
def test_one_and_two_threads_give_the_same_bits(edit: Edit, share: float) -> None:
    one, two = (session_of(edit, threads=threads).edit(edit.goal) for threads in (1, 2))
    assert one.controls.tobytes() == two.controls.tobytes()
    assert one.counters == two.counters


@pytest.mark.parametrize(("edit", "share"), CASES, ids=IDS)
def test_a_common_motion_of_all_bodies_changes_nothing(edit: Edit, share: float) -> None:
    everything = stiv.identity(edit.surface.vertex_count)
    start = edit.deformation.surface(edit.controls).astype(np.float32).astype(float)
    bodies = [stiv.Body(body.name) for body in edit.surface.bodies]
    surface = stiv.Surface(
        edit.surface.triangles, edit.surface.vertex_count, vertex_body=edit.surface.vertex_body, bodies=bodies
    )
    goal = start + (3.7, -1.3, 0.9)
    result = stiv.edit(surface, everything, start, goal)
    assert result.status == "reached"
    assert result.rounds == 0
    assert np.array_equal(result.controls, goal.astype(np.float32).astype(float))


def test_random_edits_never_intersect() -> None:
    chance = np.random.default_rng(17)
    for edit in (families.spheres(1.0, levels=1), families.sheets(0.4, cells=6), families.rigid(1.0)):
        session = session_of(edit)
        size = np.ptp(session.surface, axis=0).max()
        for _ in range(12):
            before = session.surface
            goal = session.controls + 0.1 * size * chance.normal(size=3)
            goal += 0.01 * size * chance.normal(size=goal.shape)
            still = chance.random(len(goal)) < 0.3
            goal[still] = session.controls[still]
            result = session.edit(goal)
            assert len(stiv.find_intersections(result.surface, edit.surface)) == 0
            assert path_is_free(edit, before, result, 12)
