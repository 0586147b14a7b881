# SPDX-License-Identifier: GPL-3.0-or-later
"""Each broad phase finds the events of brute force, with either narrow phase, on each family of the scene library."""

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
@pytest.mark.parametrize("narrow_phase", ["conservative", "polynomial"])
def test_events_are_those_of_brute_force(name: str, separation: float, narrow_phase: str) -> None:
    scene = SCENES[name]()
    start, end = scene.deformation.surface(scene.controls), scene.deformation.surface(scene.goal)
    expected = stiv.Detector(scene.surface, "brute_force", narrow_phase).find(start, end, separation)
    assert len(expected) > 20
    for broad_phase in ("bvh", "hash_grid"):
        found = stiv.Detector(scene.surface, broad_phase, narrow_phase).find(start, end, separation)
        for field in ("kind", "vertices", "time", "weights", "normal", "start_distance"):
            assert np.array_equal(getattr(found, field), getattr(expected, field)), (broad_phase, field)


@pytest.mark.parametrize("separation", [0.0, 0.02])
@pytest.mark.parametrize("name", SCENES)
def test_polynomials_miss_only_contacts_on_edges_and_corners(name: str, separation: float) -> None:
    scene = SCENES[name]()
    start, end = scene.deformation.surface(scene.controls), scene.deformation.surface(scene.goal)
    times, weights = by_pair(stiv.Detector(scene.surface).find(start, end, separation))
    others, _ = by_pair(stiv.Detector(scene.surface, narrow_phase="polynomial").find(start, end, separation))
    assert others.keys() <= times.keys()
    missed = times.keys() - others.keys()
    assert all(min(map(abs, weights[pair])) < 1e-9 for pair in missed)
    if separation == 0:
        assert not missed or name in MIRRORED
        assert all(time == pytest.approx(max(0.0, times[pair] - 0.01), abs=1e-3) for pair, time in others.items())


MIRRORED = ("fold", "subdivision")
"""Scenes so regular that vertices meet edges and edges meet within one plane."""


def by_pair(events: stiv.Events) -> tuple[dict[tuple[int, ...], float], dict[tuple[int, ...], list[float]]]:
    """Times and weights of events by kind and vertices."""
    pairs = [(kind, *row) for kind, row in zip(events.kind.tolist(), events.vertices.tolist(), strict=True)]
    return dict(zip(pairs, events.time.tolist(), strict=True)), dict(zip(pairs, events.weights.tolist(), strict=True))
