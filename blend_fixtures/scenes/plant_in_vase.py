# SPDX-License-Identifier: GPL-3.0-or-later
"""The main fixture: a bunch of shoots in a tri-cubic lattice above a vase whose neck is narrower than the bunch."""

from __future__ import annotations

from .colors import GLAZE, GRASS
from .fixture import Fixture, MeshObject, Placement, View, lattice_around
from .motion import Step, move, on_points, scale
from .shoots import shoots
from .vase import HEIGHT, vase

START = HEIGHT + 0.06  # height of the bunch's foot
LOWERED, GROWTH = 1.2, 1.25
LOWERINGS, SCALINGS = 48, 16


def motion() -> tuple[Step, ...]:
    """64 edits that lower the bunch into the vase and then scale it up."""
    everything = on_points("Lattice")
    growth = GROWTH ** (1 / SCALINGS)
    return (
        move(everything, (0.0, 0.0, -LOWERED / LOWERINGS), repeat=LOWERINGS),
        scale(everything, (growth, growth, growth), repeat=SCALINGS),
    )


def plant_in_vase() -> Fixture:
    """13,759 vertices and 26,782 triangles: the size of the example in the paper's Figure 8."""
    bunch = shoots().moved((0.0, 0.0, START))
    low, high = bunch.vertices.min(0) - 0.05, bunch.vertices.max(0) + 0.05
    return Fixture(
        name="plant_in_vase",
        summary="A bunch of shoots in a tri-cubic lattice lowered into a vase, then scaled up",
        meshes=(
            MeshObject("Shoots", bunch, GRASS, lattice="Lattice"),
            MeshObject("Vase", vase(), GLAZE, Placement()),
        ),
        lattices=(lattice_around("Lattice", tuple(low.tolist()), tuple(high.tolist()), (6, 6, 8)),),
        steps=motion(),
        view=View((0.0, -9.0, 3.4), (0.0, 0.0, 1.95), lens=60.0, size=(720, 810)),
    )
