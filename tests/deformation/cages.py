# SPDX-License-Identifier: GPL-3.0-or-later
"""Cages that exercise each rule of subdivision, as plain data."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class CageCase:
    """Vertices (V, 3), faces and loose edges; creases by edge (two vertices) and by vertex."""

    vertices: Floats
    faces: list[tuple[int, ...]]
    loose_edges: list[tuple[int, int]] = field(default_factory=list)
    edge_crease: dict[tuple[int, int], float] = field(default_factory=dict)
    vertex_crease: dict[int, float] = field(default_factory=dict)

    def face_edges(self) -> list[tuple[int, int]]:
        """Edges of the faces, each once, smaller vertex first."""
        ends = {tuple(sorted((f[k - 1], f[k]))) for f in self.faces for k in range(len(f))}
        return sorted(ends)  # type: ignore[arg-type]


def _noisy(points: list[tuple[float, float, float]] | Floats, seed: int = 1) -> Floats:
    vertices = np.asarray(points, float)
    return vertices + np.random.default_rng(seed).normal(scale=0.1, size=vertices.shape)


def _with_creases(case: CageCase, seed: int, edges: float = 0.0, vertices: float = 0.0) -> CageCase:
    """Add random creases to these fractions of the edges and vertices."""
    random = np.random.default_rng(seed)
    edge_crease = {edge: float(random.random()) for edge in case.face_edges() if random.random() < edges}
    vertex_crease = {v: float(random.random()) for v in range(len(case.vertices)) if random.random() < vertices}
    return CageCase(case.vertices, case.faces, case.loose_edges, edge_crease, vertex_crease)


def cube() -> CageCase:
    """Six quads."""
    corners = [(x, y, z) for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)]
    faces = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return CageCase(_noisy(corners), faces)


def cube_with_sharp_edges() -> CageCase:
    """A cube with a closed loop of infinitely sharp edges, and one edge that ends in smooth vertices."""
    case = cube()
    sharp = {(0, 1): 1.0, (1, 3): 1.0, (2, 3): 1.0, (0, 2): 1.0, (5, 7): 1.0}
    return CageCase(case.vertices, case.faces, edge_crease=sharp)


def cube_with_edge_creases() -> CageCase:
    """A cube with a random crease on every edge."""
    return _with_creases(cube(), 2, edges=1.0)


def cube_with_vertex_creases() -> CageCase:
    """A cube with vertex creases from none to infinite."""
    case = cube()
    return CageCase(case.vertices, case.faces, vertex_crease={0: 1.0, 1: 0.5, 2: 0.3, 7: 0.05})


def cube_with_both_creases() -> CageCase:
    """A cube with random creases on edges and vertices."""
    return _with_creases(cube(), 3, edges=0.7, vertices=0.7)


def torus(rings: int = 12, sides: int = 7) -> CageCase:
    """A closed surface of regular quads."""
    u, v = np.meshgrid(np.arange(rings), np.arange(sides), indexing="ij")
    a, b = 2 * np.pi * u / rings, 2 * np.pi * v / sides
    points = np.stack([(3 + np.cos(b)) * np.cos(a), (3 + np.cos(b)) * np.sin(a), np.sin(b)], -1).reshape(-1, 3)
    faces = [
        tuple(int(i % rings * sides + j % sides) for i, j in ((r, s), (r + 1, s), (r + 1, s + 1), (r, s + 1)))
        for r in range(rings)
        for s in range(sides)
    ]
    return CageCase(_noisy(points), faces)


def cylinder(sides: int = 7) -> CageCase:
    """Quads around the side, and an n-gon at each end."""
    angles = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([np.cos(angles), np.sin(angles)], -1)
    points = np.concatenate([np.insert(ring, 2, -1.0, 1), np.insert(ring, 2, 1.0, 1)])
    around = [(k, (k + 1) % sides, (k + 1) % sides + sides, k + sides) for k in range(sides)]
    return CageCase(_noisy(points), [*around, tuple(range(sides))[::-1], tuple(range(sides, 2 * sides))])


def creased_cylinder() -> CageCase:
    """A cylinder with creases, some on the edges of the n-gons."""
    return _with_creases(cylinder(), 4, edges=0.5, vertices=0.2)


def octahedron() -> CageCase:
    """Only triangles."""
    points = [(1.0, 0, 0), (0, 1.0, 0), (-1.0, 0, 0), (0, -1.0, 0), (0, 0, 1.0), (0, 0, -1.0)]
    faces = [f for k in range(4) for f in ((k, (k + 1) % 4, 4), ((k + 1) % 4, k, 5))]
    return CageCase(_noisy(points), faces)


def grid(side: int = 5) -> CageCase:
    """An open sheet of quads."""
    points = [(float(i), float(j), 0.3 * np.sin(1.3 * i + j)) for j in range(side) for i in range(side)]
    faces = [
        (j * side + i, j * side + i + 1, (j + 1) * side + i + 1, (j + 1) * side + i)
        for j in range(side - 1)
        for i in range(side - 1)
    ]
    return CageCase(_noisy(points), faces)


def creased_grid() -> CageCase:
    """An open sheet with creases, including its boundary and corners."""
    return _with_creases(grid(), 5, edges=0.3, vertices=0.2)


def triangle() -> CageCase:
    """One triangle, all boundary."""
    return CageCase(np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0.2)]), [(0, 1, 2)])


def pentagon() -> CageCase:
    """One n-gon, all boundary."""
    return CageCase(np.array([(0, 0, 0), (1, 0, 0), (1.3, 1, 0.2), (0.5, 1.6, 0), (-0.3, 0.8, 0.1)]), [(0, 1, 2, 3, 4)])


def mixed_strip() -> CageCase:
    """A pentagon, a quad and a triangle in a row."""
    points = [(0, 0, 0), (1, 0, 0), (1.3, 1, 0.2), (0.5, 1.6, 0), (-0.3, 0.8, 0.1), (2, 0, 0), (2.3, 1, 0), (1.6, 2, 0)]
    return CageCase(np.array(points, float), [(0, 1, 2, 3, 4), (1, 5, 6, 2), (2, 6, 7)])


def three_faces_on_an_edge() -> CageCase:
    """A non-manifold edge."""
    points = [(0, 0, 0), (0, 1, 0), (1, 0, 0), (1, 1, 0), (-1, 0, 0.5), (-1, 1, 0.5), (0, 0, 1), (0, 1, 1)]
    return CageCase(_noisy(np.array(points, float)), [(0, 2, 3, 1), (0, 1, 5, 4), (0, 1, 7, 6)])


def cubes_sharing_an_edge() -> CageCase:
    """Two closed cubes that share an edge, with four faces on it."""
    first = cube()
    renamed = {0: 3, 4: 7, **{v: 7 + k for k, v in enumerate((1, 2, 3, 5, 6, 7), 1)}}
    moved = first.vertices + np.array([2.0, 2.0, 0.0])
    vertices = np.concatenate([first.vertices, moved[[1, 2, 3, 5, 6, 7]]])
    return CageCase(vertices, first.faces + [tuple(renamed[v] for v in f) for f in first.faces])


def bow_tie() -> CageCase:
    """Two quads that share a vertex."""
    points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0.3), (-1, 0, 0.2), (-1, -1, 0), (0, -1, 0)]
    return CageCase(np.array(points, float), [(0, 1, 2, 3), (0, 4, 5, 6)])


def flipped_neighbour() -> CageCase:
    """An open sheet with one face of the wrong orientation."""
    case = grid(4)
    return CageCase(case.vertices, [case.faces[0][::-1], *case.faces[1:]])


def loose_vertices() -> CageCase:
    """A quad and loose vertices."""
    return CageCase(_noisy(np.zeros((7, 3)), 6), [(1, 2, 4, 5)])


def wires() -> CageCase:
    """Loose edges: an open chain, a closed chain, a branch and a single edge; some with creases."""
    chain, ring, fork, single = (
        [(0, 1), (2, 1), (2, 3)],
        [(4, 5), (6, 5), (6, 4)],
        [(7, 8), (7, 9), (7, 10)],
        [(11, 12)],
    )
    points = np.random.default_rng(7).normal(size=(13, 3))
    return CageCase(points, [], [*chain, *ring, *fork, *single], {(0, 1): 1.0}, {2: 1.0, 5: 0.4})


def wires_on_a_sheet() -> CageCase:
    """Wires that start at vertices of faces: at a corner, on the boundary and inside; one or two per vertex."""
    case = grid(4)
    extra = np.random.default_rng(8).normal(size=(7, 3)) + np.array([1.5, 1.5, 2.0])
    loose = [(0, 16), (16, 17), (5, 18), (6, 19), (20, 6), (2, 21), (22, 21), (22, 7)]
    return CageCase(np.concatenate([case.vertices, extra]), case.faces, loose)


CASES: list[Callable[[], CageCase]] = [
    cube,
    cube_with_sharp_edges,
    cube_with_edge_creases,
    cube_with_vertex_creases,
    cube_with_both_creases,
    torus,
    cylinder,
    creased_cylinder,
    octahedron,
    grid,
    creased_grid,
    triangle,
    pentagon,
    mixed_strip,
    three_faces_on_an_edge,
    cubes_sharing_an_edge,
    bow_tie,
    flipped_neighbour,
    loose_vertices,
    wires,
    wires_on_a_sheet,
]
