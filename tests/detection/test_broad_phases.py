# SPDX-License-Identifier: GPL-3.0-or-later
"""Every broad phase finds what brute force finds, on every family of the scene library."""

from collections.abc import Callable

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes import families

SCENES: dict[str, Callable[[], families.Edit]] = {
    "spheres": lambda: families.spheres(1.5, levels=2),
    "sheets": lambda: families.sheets(1.0),
    "fold": families.fold,
    "subdivision": lambda: families.subdivision(1.2, levels=2),
    "vase": lambda: families.vase(2.2, count=6),
    "rigid": lambda: families.rigid(1.6),
    "knot": lambda: families.knot(1.0, rings=60, sides=8),
}


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("separation", [0.0, 0.02])
def test_events_are_those_of_brute_force(name: str, separation: float) -> None:
    scene = SCENES[name]()
    start, end = scene.deformation.surface(scene.controls), scene.deformation.surface(scene.goal)
    expected = stiv.Detector(scene.surface, "brute_force").find(start, end, separation)
    assert len(expected) > 20
    for broad_phase in ("bvh", "hash_grid"):
        found = stiv.Detector(scene.surface, broad_phase).find(start, end, separation)
        for field in ("kind", "vertices", "time", "weights", "normal", "start_distance"):
            assert np.array_equal(getattr(found, field), getattr(expected, field)), (broad_phase, field)
