# SPDX-License-Identifier: GPL-3.0-or-later
"""Contraction, expansion and repair of cages: the subdivided surface intersects, and the cage moves."""

from __future__ import annotations

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes.primitives import icosphere
from blend_fixtures.scenes.tangled import hairpin

LEVELS = 1


class CagedHairpin:
    """A bent tube as the cage of a Catmull-Clark surface, thick enough for its legs to intersect."""

    def __init__(self) -> None:
        tube = hairpin(0.28, rings=24, sides=8)
        self.cage = tube.surface
        self.controls = tube.positions.astype(np.float32).astype(float)
        faces = tuple(map(tuple, tube.surface.triangles.tolist()))
        self.deformation, self.triangles = stiv.catmull_clark(stiv.Cage.of_faces(faces), LEVELS)

    def pairs(self, controls: np.ndarray) -> int:
        return len(stiv.find_intersections(self.deformation.surface(controls), self.triangles))


@pytest.fixture(scope="module")
def tube() -> CagedHairpin:
    return CagedHairpin()


def test_a_cage_is_repaired_and_its_surface_is_clear(tube: CagedHairpin) -> None:
    assert tube.pairs(tube.controls) > 60
    result = stiv.repair(tube.triangles, tube.controls, deformation=tube.deformation, cage=tube.cage)
    assert result.status == "repaired"
    assert result.positions.shape == tube.controls.shape
    assert tube.pairs(result.positions) == 0
    assert np.array_equal(result.positions, result.positions.astype(np.float32))
    before, after = (tube.deformation.surface(p) for p in (tube.controls, result.positions))
    rms = np.sqrt(((after - before) ** 2).sum(axis=1).mean()) / np.linalg.norm(np.ptp(before, axis=0))
    assert rms == pytest.approx(result.deviation)
    assert rms < 0.02


def test_contraction_counts_pairs_of_the_surface(tube: CagedHairpin) -> None:
    found = stiv.contract(tube.triangles, tube.controls, deformation=tube.deformation, cage=tube.cage)
    assert found.free
    assert found.pairs[0] == tube.pairs(tube.controls)
    assert tube.pairs(found.positions) == 0
    step = stiv.contraction_step(tube.cage, tube.controls)
    assert found.pairs[1] == tube.pairs(step.astype(np.float32).astype(float))
    back = stiv.expand(tube.triangles, found.positions, tube.controls, deformation=tube.deformation)
    assert back.status == "corrected"
    assert tube.pairs(back.controls) == 0


def test_fixed_controls_stay(tube: CagedHairpin) -> None:
    moves = np.arange(len(tube.controls)) >= len(tube.controls) // 2
    options = stiv.RepairOptions(moves=moves)
    result = stiv.repair(tube.triangles, tube.controls, options, deformation=tube.deformation, cage=tube.cage)
    assert np.array_equal(result.positions[~moves], tube.controls[~moves])
    assert (tube.pairs(result.positions) == 0) == (result.status == "repaired")


def test_a_cage_next_to_a_fixed_object() -> None:
    """Two spheres, a cage and a fixed obstacle, with concatenated deformations like Blender's objects."""
    ball = icosphere(1)
    faces = tuple(map(tuple, ball.faces))
    deformation, triangles = stiv.catmull_clark(stiv.Cage.of_faces(faces), 1)
    controls, still = ball.vertices, 0.6 * icosphere(2).vertices + (1.2, 0.1, 0.0)
    count = deformation.vertex_count
    surface = stiv.Surface(
        np.vstack([triangles, np.array(icosphere(2).faces) + count]), count + len(still),
        vertex_body=np.repeat([0, 1], [count, len(still)]),
        bodies=[stiv.Body("cage"), stiv.Body("still", "fixed")],
    )  # fmt: skip
    start = np.vstack([deformation.surface(controls), still])
    whole = stiv.concatenate([(deformation, np.arange(count))], start)
    result = stiv.repair(surface, controls, deformation=whole, cage=np.array(faces))
    assert result.status == "repaired"
    after = whole.surface(result.positions)
    assert len(stiv.find_intersections(after, surface)) == 0
    assert np.array_equal(after[count:], still)


def test_mismatched_input_is_refused_in_words(tube: CagedHairpin) -> None:
    with pytest.raises(stiv.InputError, match="cage: a deformation needs the triangles"):
        stiv.repair(tube.triangles, tube.controls, deformation=tube.deformation)
    with pytest.raises(stiv.InputError, match="cage: there is no deformation"):
        stiv.repair(tube.cage, tube.controls, cage=tube.cage)
    weld = stiv.RepairOptions(weld=True)
    with pytest.raises(stiv.InputError, match="weld its cage first"):
        stiv.repair(tube.triangles, tube.controls, weld, deformation=tube.deformation, cage=tube.cage)
