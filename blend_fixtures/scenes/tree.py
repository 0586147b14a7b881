# SPDX-License-Identifier: GPL-3.0-or-later
"""A tree of loose pieces: trunk and branches are separate closed tubes, and leaves are free."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import stiv

from .shape import Shape, joined
from .sweeps import tube

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Tree:
    """Parameters of the tree; lengths in world units."""

    leaves: int = 7855
    candidates: int = 15000  #: candidate leaves; those that intersect something are omitted
    height: float = 2.0
    forks: tuple[int, ...] = (9, 4)  #: limbs of the trunk, twigs of a limb
    leaf: float = 0.085  #: length of a leaf
    seed: int = 5


@dataclass(frozen=True)
class _Branch:
    line: Array  #: (k, 3)
    radii: Array  #: (k,)


def tree(kind: Tree = Tree()) -> Shape:
    """The tree standing at the origin, without any intersections."""
    chance = np.random.default_rng(kind.seed)
    branches = _branches(kind, chance)
    tubes = [tube(branch.line, branch.radii, 6) for branch in branches]
    kept = _apart(joined(tubes), np.repeat(np.arange(len(tubes)), [len(t.triangles()) for t in tubes]))
    wood = joined([tubes[number] for number in kept])
    twigs = [branches[number] for number in kept if number > kind.forks[0]]
    return joined([wood, _free_leaves(kind, chance, twigs, wood)])


def _apart(shape: Shape, owner: NDArray[np.int64]) -> list[int]:
    """Indices of the pieces that intersect no earlier chosen piece; `owner` is the piece of each triangle."""
    pairs = np.unique(np.sort(owner[stiv.find_intersections(shape.vertices, shape.triangles())], axis=1), axis=0)
    dropped: set[int] = set()
    for first, second in pairs[np.argsort(pairs[:, 1], kind="stable")].tolist():
        if first != second and first not in dropped:
            dropped.add(second)
    return [number for number in range(int(owner.max()) + 1) if number not in dropped]


def _branches(kind: Tree, chance: np.random.Generator) -> list[_Branch]:
    """The trunk, then its limbs, then their twigs."""
    trunk = _curve(np.zeros(3), np.array([0.0, 0.0, kind.height * 0.72]), 0.09, 0.05, chance)
    grown, parents = [trunk], [trunk]
    for level, forks in enumerate(kind.forks):
        children = []
        for number, parent in enumerate(parents):
            for fork in range(forks):
                along = 0.32 + 0.66 * (fork + 0.5) / forks
                turn = 2.4 * fork + 1.1 * number + chance.uniform(-0.25, 0.25)  # 2.4: the golden angle, about
                children.append(_child(parent, along, turn, level, kind, chance))
        grown += children
        parents = children
    return grown


def _child(parent: _Branch, along: float, turn: float, level: int, kind: Tree, chance: np.random.Generator) -> _Branch:
    """A branch from `parent` at a fraction of its length, starting slightly outside its bark."""
    place = along * (len(parent.line) - 1)
    at = np.array([np.interp(place, np.arange(len(parent.line)), parent.line[:, k]) for k in range(3)])
    girth = float(np.interp(place, np.arange(len(parent.line)), parent.radii))
    upward = parent.line[-1] - parent.line[0]
    upward /= np.linalg.norm(upward)
    across = np.cross(upward, [0.83, 0.21, 0.51])
    across /= np.linalg.norm(across)
    out = np.cos(turn) * across + np.sin(turn) * np.cross(upward, across)
    reach = kind.height * (0.46, 0.26)[level] * (1.1 - 0.5 * along) * chance.uniform(0.85, 1.1)
    direction = (0.80 * out + 0.6 * upward) if level == 0 else (0.72 * out + 0.7 * upward)
    width = girth * (0.5, 0.6)[level]
    first = at + out * (girth + 1.9 * width)
    return _curve(first, first + reach * direction, width, 0.45 * width, chance, lift=0.22 * reach)


def _curve(
    first: Array, last: Array, radius: float, end_radius: float, chance: np.random.Generator, lift: float = 0.0
) -> _Branch:
    """A line of points that bends slightly sideways and rises toward its end."""
    along = np.linspace(0, 1, 5)[:, None]
    aside = 0.08 * np.linalg.norm(last - first) * chance.normal(size=3) * (np.abs(last - first) < 1.4)
    line = first + along * (last - first) + np.sin(np.pi * along) * aside + lift * along**2 * [0, 0, 1]
    return _Branch(line, radius + along[:, 0] * (end_radius - radius))


def _free_leaves(kind: Tree, chance: np.random.Generator, twigs: list[_Branch], wood: Shape) -> Shape:
    """The first `leaves` candidates that intersect neither wood nor an earlier chosen leaf."""
    tried = _leaves(kind.candidates, kind.leaf, twigs, chance)
    whole = joined([wood, tried])
    owner = np.maximum((np.arange(len(whole.faces)) - len(wood.faces)) // 2, -1) + 1  # 0 is the wood
    kept = [piece - 1 for piece in _apart(whole, owner)[1 : kind.leaves + 1]]
    corners = tried.vertices.reshape(-1, 4, 3)[kept].reshape(-1, 3)
    return Shape(corners, _leaf_faces(len(kept)))


def _leaf_faces(count: int) -> tuple[tuple[int, ...], ...]:
    """Two triangles per leaf that share its midrib."""
    return tuple(face for a in range(0, 4 * count, 4) for face in ((a, a + 1, a + 2), (a, a + 2, a + 3)))


def _leaves(count: int, length: float, twigs: list[_Branch], chance: np.random.Generator) -> Shape:
    """Pointed leaves, folded along their midrib and separate from twigs: stem, side, tip, side."""
    lines = np.stack([twig.line for twig in twigs])
    which, along = chance.integers(len(twigs), size=count), chance.uniform(0.15, 1.08, count) * 4
    cell = np.minimum(along.astype(int), 3)
    start, end = lines[which, cell], lines[which, cell + 1]
    foot = start + (along - cell)[:, None] * (end - start)
    axis = (end - start) / np.linalg.norm(end - start, axis=1)[:, None]
    out = _unit(np.cross(axis, chance.normal(size=(count, 3))))
    stalk = chance.uniform(0.02, 0.2, count)[:, None]
    size = length * chance.uniform(0.6, 1.15, count)[:, None]
    rib = _unit(out + 0.5 * axis + chance.normal(scale=0.35, size=(count, 3)))
    side = _unit(np.cross(rib, [0, 0, 1] + chance.normal(scale=0.5, size=(count, 3))))
    fold = np.cross(side, rib)
    stem = foot + stalk * out
    edge = stem + 0.45 * size * rib + 0.13 * size * fold
    corners = np.stack([stem, edge + 0.27 * size * side, stem + size * rib, edge - 0.27 * size * side], axis=1)
    return Shape(corners.reshape(-1, 3), _leaf_faces(count))


def _unit(vectors: Array) -> Array:
    result: Array = vectors / np.linalg.norm(vectors, axis=1)[:, None]
    return result
