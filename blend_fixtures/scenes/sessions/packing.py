# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 4: nine organ-like soft objects, Loop subdivision surfaces, packed tightly into a bowl."""

from __future__ import annotations

import numpy as np

from ..organs import bowl, organs
from .session import Array, Edit, Session, Stage, single
from .subdivision_parts import Parts, part

# : Start and goal of each organ; the goals overlap.
PLACES: dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    "Gut": ((0.0, 0.0, 1.2), (0.0, 0.0, -0.5)),
    "Left kidney": ((0.5, 0.0, 2.6), (0.5, 0.1, -0.3)),
    "Right kidney": ((-0.5, 0.0, 2.6), (-0.5, 0.1, -0.3)),
    "Liver": ((-0.05, -0.15, 3.5), (-0.05, -0.2, -0.05)),
    "Stomach": ((0.1, 0.1, 4.4), (0.15, 0.15, 0.05)),
    "Spleen": ((0.5, 0.1, 5.2), (0.5, 0.3, 0.15)),
    "Left lung": ((0.4, 0.0, 6.1), (0.38, 0.1, 0.45)),
    "Right lung": ((-0.4, 0.0, 6.1), (-0.38, 0.1, 0.45)),
    "Heart": ((0.0, -0.1, 7.1), (0.0, -0.1, 0.4)),
}
MOVES = 60


def parts() -> Parts:
    """The organs above the bowl, side by side."""
    cages = {name: shape.moved(PLACES[name][0]) for name, shape in organs().items()}
    return Parts({**{name: part(cage, 1) for name, cage in cages.items()}, "Bowl": part(bowl(), 0)})


def toward(scene: Parts, names: list[str]) -> Edit:
    """An edit that moves each organ by one step of its path."""
    ways = [np.subtract(PLACES[name][1], PLACES[name][0]) / MOVES for name in names]
    step = np.concatenate([np.tile(way, (len(scene.cages[name]), 1)) for name, way in zip(names, ways, strict=True)])

    def goal(controls: Array) -> Array:
        result: Array = controls + step
        return result

    return goal


def stage() -> Stage:
    """All organs lowered together, toward goals that overlap."""
    scene = parts()
    names = [name for name in scene.parts if name != "Bowl"]
    return scene.by_cages("packing", names, (toward(scene, names),) * MOVES)


def session() -> Session:
    """The whole packing."""
    return Session("packing", 4, "Nine soft organs packed into a bowl", single(stage))
