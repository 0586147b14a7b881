# SPDX-License-Identifier: GPL-3.0-or-later
"""The comparison with converged solutions: its solver's derivatives, its figures, and what it refuses."""

from pathlib import Path

import numpy as np
import pytest

import stiv
from benchmarks.quality.cases import cases, rigidly
from benchmarks.quality.comparison import WAYS, energy_ratios, quality, quality_text
from benchmarks.quality.pictures import worst
from blend_fixtures.scenes.primitives import icosphere, triangulated


def rows_of(edit: str, energies: tuple[float, ...]) -> list[dict[str, object]]:
    return [
        {"edit": edit, "way": way, "energy": energy, "reached": energy == 0, "kept": 0.5, "stretch": 1, "seconds": 1}
        for way, energy in zip(WAYS, energies, strict=True)
    ]


def test_energies_are_compared_where_neither_reached_the_goal() -> None:
    rows = [
        *rows_of("a", (9, 3, 2, 2, 3, 3, 3, 2)),
        *rows_of("b", (9, 0, 0, 0, 3, 3, 3, 1)),
        *rows_of("c", (9, 8, 2, 2, 3, 3, 3, 2)),
    ]
    assert energy_ratios(rows, "edit") == {"a": 1.5, "c": 4.0}
    assert worst(rows) == ["c", "a"]
    assert "2.449" in quality_text(rows)  # the geometric mean of 1.5 and 4


def test_a_rigid_step_moves_the_surface_by_its_derivatives() -> None:
    pytest.importorskip("scipy")
    from benchmarks.interior_point import RigidMotion

    ball = triangulated(icosphere(1, 0.3)).moved((0.2, 0.1, 0.4))
    edit = rigidly("ball", ball, [ball.moved((3, 0, 0))], (1, 0, 0), (0, 0, 1))
    motion, p = RigidMotion(edit), edit.controls + [[0.1, 0.2, 0.3], [0.4, -0.5, 0.6]]
    before, step = edit.deformation.surface(p), np.array([[0.3, -0.2, 0.5], [0.7, 0.1, -0.4]])
    after = edit.deformation.surface(motion.along(p, step, 1e-6))
    found = (motion.derivatives(p, before)[0] @ step.ravel()).reshape(-1, 3)
    assert np.allclose((after - before) / 1e-6, found, atol=1e-5)
    assert not found[len(ball.vertices) :].any()


def test_an_unknown_edit_and_a_folder_without_models_are_refused(tmp_path: Path) -> None:
    pytest.importorskip("ipctk")
    pytest.importorskip("scipy")
    with pytest.raises(stiv.InputError, match="there is no edit nothing"):
        quality(tmp_path, ["nothing"], 1, print)
    with pytest.raises(stiv.InputError, match="there is no such file"):
        cases(tmp_path)["ogre bent"]()
