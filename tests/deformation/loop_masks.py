# SPDX-License-Identifier: GPL-3.0-or-later
"""Loop subdivision by its published masks, written for clarity, not speed.

Inner vertices and edges [Loop 1987], creases, boundaries, corners and limit positions [Hoppe et al. 1994,
section 4; the limit mask of a crease between regular vertices], sharpness that decreases by one per level
[DeRose et al. 1998].
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Edge = tuple[int, int]


def _edge(a: int, b: int) -> Edge:
    return (a, b) if a < b else (b, a)


def _beta(valence: int) -> float:
    """Weight of each neighbour of an inner vertex."""
    return (0.625 - (0.375 + 0.25 * np.cos(2 * np.pi / valence)) ** 2) / valence


@dataclass(frozen=True)
class LoopMesh:
    """Triangles over `count` vertices, with sharpness of edges and vertices; all others are smooth."""

    count: int
    triangles: list[tuple[int, int, int]]
    edge_sharpness: dict[Edge, float]
    vertex_sharpness: dict[int, float]

    def edges(self) -> list[Edge]:
        """Each edge once, smaller vertex first, in lexicographic order."""
        return sorted({_edge(t[k - 1], t[k]) for t in self.triangles for k in range(3)})

    def opposite(self) -> dict[Edge, list[int]]:
        """The opposite corners of the triangles on each edge."""
        found: dict[Edge, list[int]] = {}
        for t in self.triangles:
            for k in range(3):
                found.setdefault(_edge(t[k - 1], t[k]), []).append(t[k - 2])
        return found

    def is_sharp(self, edge: Edge, opposite: dict[Edge, list[int]]) -> bool:
        """A crease, or a boundary."""
        return self.edge_sharpness.get(edge, 0.0) > 0 or len(opposite[edge]) == 1

    def around(self) -> list[tuple[list[int], list[int], bool]]:
        """For each vertex: all neighbours, those along sharp edges, and whether it is fixed."""
        opposite = self.opposite()
        neighbours: list[list[int]] = [[] for _ in range(self.count)]
        sharp: list[list[int]] = [[] for _ in range(self.count)]
        for a, b in self.edges():
            for here, there in ((a, b), (b, a)):
                neighbours[here].append(there)
                if self.is_sharp((a, b), opposite):
                    sharp[here].append(there)
        corner = [self.vertex_sharpness.get(v, 0.0) > 0 or len(sharp[v]) > 2 for v in range(self.count)]
        return list(zip(neighbours, sharp, corner, strict=True))

    def refine(self) -> tuple[LoopMesh, Floats]:
        """The mesh after one level, with the old vertices first and then one per edge; weights (n', n)."""
        edges, opposite, corners = self.edges(), self.opposite(), np.eye(self.count)
        weights = np.zeros((self.count + len(edges), self.count))
        for v, (neighbours, sharp, corner) in enumerate(self.around()):
            if corner or not neighbours:
                weights[v] = corners[v]
            elif len(sharp) == 2:
                weights[v] = 0.75 * corners[v] + corners[sharp].sum(axis=0) / 8
            else:
                beta = _beta(len(neighbours))
                weights[v] = (1 - len(neighbours) * beta) * corners[v] + beta * corners[neighbours].sum(axis=0)
        for k, edge in enumerate(edges):
            ends = corners[list(edge)].sum(axis=0)
            smooth = 3 / 8 * ends + corners[opposite[edge]].sum(axis=0) / 8
            weights[self.count + k] = ends / 2 if self.is_sharp(edge, opposite) else smooth
        middle = {edge: self.count + k for k, edge in enumerate(edges)}
        finer = []
        for a, b, c in self.triangles:
            ab, bc, ca = middle[_edge(a, b)], middle[_edge(b, c)], middle[_edge(c, a)]
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        worn = {
            _edge(end, middle[edge]): value - 1
            for edge, value in self.edge_sharpness.items()
            if value > 1
            for end in edge
        }
        vertices = {v: value - 1 for v, value in self.vertex_sharpness.items() if value > 1}
        return LoopMesh(len(weights), finer, worn, vertices), weights

    def limit(self) -> Floats:
        """Weights (n, n) of the limit positions, if sharp elements stay sharp."""
        corners = np.eye(self.count)
        weights = np.zeros((self.count, self.count))
        for v, (neighbours, sharp, corner) in enumerate(self.around()):
            if corner or not neighbours:
                weights[v] = corners[v]
            elif len(sharp) == 2:
                weights[v] = (4 * corners[v] + corners[sharp].sum(axis=0)) / 6
            else:
                share = 1 / (3 / (8 * _beta(len(neighbours))) + len(neighbours))
                weights[v] = (1 - len(neighbours) * share) * corners[v] + share * corners[neighbours].sum(axis=0)
        return weights


def subdivided(mesh: LoopMesh, vertices: Floats, levels: int, limit: bool) -> tuple[Floats, NDArray[np.int64]]:
    """Positions and triangles after this many levels, optionally on the limit surface."""
    for _ in range(levels):
        mesh, weights = mesh.refine()
        vertices = weights @ vertices
    return mesh.limit() @ vertices if limit else vertices, np.array(mesh.triangles)
