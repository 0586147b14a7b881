# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 10: a tree, mostly triangle soup, grows in a corner and spreads over the edges of its walls."""

from __future__ import annotations

import itertools
from dataclasses import replace
from functools import cache

from ..colors import LEAF, STILL
from ..fixture import Fixture, MeshObject, View, lattice_around
from ..motion import on_points, scale
from ..primitives import triangulated
from ..shape import Shape
from ..tree import tree
from ..voxels import voxel_surface
from .lattice_stage import lattice_stage
from .session import Session, Stage, repeated, scaled, single

GROWTH, SCALINGS = 1.7, 100
LARGE_GROWTH, LARGE_SCALINGS = 2.34, 40  # for more contacts per round than in the paper
DISTANCE = 1.32  # of the trunk from both walls
BRICK = 0.5


def corner(size: int = 5, height: int = 4, start: int = -1) -> Shape:
    """A triangulated floor and two walls, one brick thick, that meet at the origin."""
    inner = range(start + 1, size)
    floor = set(itertools.product(inner, inner, (start,)))
    left = set(itertools.product((start,), range(start, size), range(start, height)))
    back = set(itertools.product(range(start, size), (start,), range(start, height)))
    return triangulated(voxel_surface(floor | left | back)).scaled(BRICK)


@cache
def _shapes() -> tuple[Shape, Shape]:
    return tree().moved((DISTANCE, DISTANCE, 0.2)), corner()


def tree_in_corner() -> Fixture:
    """32,937 vertices and 18,745 triangles in the paper, equal within 1 %."""
    plant, walls = _shapes()
    low, high = plant.vertices.min(0) - 0.05, plant.vertices.max(0) + 0.05
    growth = GROWTH ** (1 / SCALINGS)
    return Fixture(
        name="tree_in_corner",
        summary="A tree in a tri-cubic lattice grows in a corner and creeps over the edges of its walls",
        meshes=(
            MeshObject("Tree", plant, LEAF, lattice="Lattice", smooth=False),
            MeshObject("Corner", walls, STILL, smooth=False),
        ),
        lattices=(lattice_around("Lattice", tuple(low.tolist()), tuple(high.tolist()), (6, 6, 7)),),
        steps=(scale(on_points("Lattice"), (growth, growth, growth), repeat=SCALINGS),),
        view=View((7.0, 5.4, 4.6), (0.9, 0.9, 1.2), lens=50.0),
    )


def session() -> Session:
    """The fixture's edits without Blender."""
    return Session("tree", 10, "A tree grows in a corner", single(lambda: lattice_stage(tree_in_corner())))


def _large_stage() -> Stage:
    growth = LARGE_GROWTH ** (1 / LARGE_SCALINGS)
    return replace(lattice_stage(tree_in_corner()), edits=repeated(scaled(growth), LARGE_SCALINGS))


def large_moves() -> Session:
    """The tree grows larger, in scalings four times as large, for more contacts per round than in the paper."""
    return Session("tree", 10, "A tree grows in a corner by large scalings", single(_large_stage))
