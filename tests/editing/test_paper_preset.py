# SPDX-License-Identifier: GPL-3.0-or-later
"""The preset of the published method: worse than the defaults, and accepted by the same test."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes import families
from blend_fixtures.scenes.families import Edit

EDITS = [families.sheets(0.5, cells=8), families.subdivision(0.6, levels=2), families.knot(0.5, rings=90, sides=6)]
VARIANTS = [{}, {"solver": "linear"}, {"constraints": "single"}, {"separation": 0.01}]
PRESETS = [stiv.EditOptions.paper, stiv.EditOptions.paper_frozen]


def answer(edit: Edit, options: stiv.EditOptions) -> stiv.EditResult:
    return stiv.edit(edit.surface, edit.deformation, edit.controls, edit.goal, options)


@pytest.mark.parametrize("preset", PRESETS, ids=lambda preset: preset.__name__)
@pytest.mark.parametrize("variant", VARIANTS, ids=str)
@pytest.mark.parametrize("edit", EDITS, ids=lambda edit: edit.name)
def test_the_presets_pass_the_exact_test_and_end_further_from_the_goal(
    edit: Edit, variant: dict[str, object], preset: Callable[..., stiv.EditOptions]
) -> None:
    published = answer(edit, preset(**{**edit.options, **variant}))
    assert len(stiv.find_intersections(published.surface, edit.surface)) == 0
    ours = answer(edit, stiv.EditOptions(**edit.options))
    assert ours.energy < published.energy


@pytest.mark.parametrize("edit", EDITS, ids=lambda edit: edit.name)
def test_the_full_gradient_ends_closer_than_a_stop_and_than_the_frozen_gradient(edit: Edit) -> None:
    start, goal = (edit.deformation.surface(p) for p in (edit.controls, edit.goal))
    time = stiv.Detector(edit.surface).earliest_time(start, goal)
    stopped = edit.deformation.surface(edit.controls + time * (edit.goal - edit.controls))
    whole, frozen = (answer(edit, preset(**edit.options)).energy for preset in PRESETS)
    assert whole < 0.5 * ((stopped - goal) ** 2).sum()
    assert whole < frozen


def test_one_vertex_against_a_wall_takes_the_step_of_algorithm_1() -> None:
    """Computed by hand: the contact is at T = 1/2, reported at t = T - 1/100, and V = A (1 - t) (-D) with D =
    2.

    The full gradient is A (1 - t + T) = 1.01 A: the step lifts the vertex by 0.51 / 1.01 D, just off the wall. The
        frozen gradient is A (1 - t): it lifts the vertex by D, back to its start.
    """
    vertices = np.array([[0.2, 0.2, 1.0], [0, 0, 0], [1, 0, 0], [0, 1, 0]])
    surface = stiv.Surface(
        [[1, 2, 3]],
        vertex_count=4,
        vertex_body=[0, 1, 1, 1],
        bodies=[stiv.Body("point"), stiv.Body("wall", "fixed")],
    )
    goal = vertices + [[0, 0, -2.0], [0, 0, 0], [0, 0, 0], [0, 0, 0]]
    weights = [1, 0, 0, 0]
    for preset, height in zip(PRESETS, (0.51 / 1.01 * 2 - 1, 1), strict=True):
        result = stiv.edit(surface, stiv.identity(4), vertices, goal, preset(weights=weights))
        assert result.rounds == 1
        assert result.controls[0] == pytest.approx([0.2, 0.2, height], abs=1e-6)
    assert stiv.edit(surface, stiv.identity(4), vertices, goal, stiv.EditOptions(weights=weights)).controls[0, 2] < 1e-3


def test_options_replace_those_of_the_preset_and_are_checked() -> None:
    options = stiv.EditOptions.paper(metric="energy", separation=0.1)
    assert (options.volumes, options.metric, options.separation) == ("published", "energy", 0.1)
    with pytest.raises(stiv.InputError, match="solver"):
        stiv.edit([[0, 1, 2]], stiv.identity(3), np.eye(3), np.eye(3) + 1, stiv.EditOptions(solver="simplex"))
    assert stiv.EditOptions.paper_frozen(metric="energy").volumes == "published_frozen"
    assert "Algorithm 1" in stiv.PAPER_DIFFERENCES
