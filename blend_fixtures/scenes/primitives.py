# SPDX-License-Identifier: GPL-3.0-or-later
"""The simple shapes of fixtures: grids, boxes, spheres and tori."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from .shape import Shape


def grid(columns: int, rows: int, size_x: float = 1.0, size_y: float = 1.0) -> Shape:
    """A flat centred sheet in the plane z = 0: `columns` x `rows` quads, with y running fastest."""
    x, y = np.meshgrid(
        np.linspace(-size_x / 2, size_x / 2, columns + 1), np.linspace(-size_y / 2, size_y / 2, rows + 1), indexing="ij"
    )
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    step = rows + 1
    corners = [i * step + j for i in range(columns) for j in range(rows)]
    return Shape(vertices, tuple((a, a + step, a + step + 1, a + 1) for a in corners))


def triangulated(shape: Shape) -> Shape:
    """The same vertices with every face split into triangles; quads alternate their diagonal from face to face."""
    faces: list[tuple[int, ...]] = []
    for number, face in enumerate(shape.faces):
        first = number % 2 if len(face) == 4 else 0
        turned = face[first:] + face[:first]
        faces += [(turned[0], turned[i], turned[i + 1]) for i in range(1, len(turned) - 1)]
    return Shape(shape.vertices, tuple(faces))


def box(cuts: int = 1, size: tuple[float, float, float] = (2.0, 2.0, 2.0)) -> Shape:
    """A closed box around the origin with `cuts` x `cuts` quads on each side."""
    index: dict[tuple[int, ...], int] = {}
    faces = []
    for axis, end in itertools.product(range(3), (0, cuts)):
        for i, j in itertools.product(range(cuts), range(cuts)):
            corners = []
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                place = [0, 0, 0]
                place[axis], place[(axis + 1) % 3], place[(axis + 2) % 3] = end, i + a, j + b
                corners.append(index.setdefault(tuple(place), len(index)))
            faces.append(tuple(corners if end else corners[::-1]))
    vertices = (np.array(list(index), float) / cuts - 0.5) * size
    return Shape(vertices, tuple(faces))


def icosphere(levels: int, radius: float = 1.0) -> Shape:
    """An icosahedron whose faces are split into four `levels` times, with vertices on the sphere."""
    golden = (1 + 5**0.5) / 2
    rows = [(sign_a, sign_b * golden) for sign_a in (-1, 1) for sign_b in (-1, 1)]
    vertices = [np.roll((0.0, a, b), shift) for shift in range(3) for a, b in rows]
    corners = np.array(vertices)
    near = np.linalg.norm(corners[:, None] - corners[None], axis=2) < 2.1
    faces = [
        f for f in itertools.combinations(range(12), 3) if all(near[a, b] for a, b in itertools.combinations(f, 2))
    ]
    outward = [f if np.linalg.det(corners[list(f)]) > 0 else f[::-1] for f in faces]
    shape = Shape(corners, tuple(outward))
    for _ in range(levels):
        shape = _quartered(shape)
    return Shape(radius * shape.vertices / np.linalg.norm(shape.vertices, axis=1)[:, None], shape.faces)


def _quartered(shape: Shape) -> Shape:
    """Every triangle split into four at the midpoints of its edges."""
    vertices: list[NDArray[np.float64]] = list(shape.vertices)
    middles: dict[tuple[int, int], int] = {}

    def middle(a: int, b: int) -> int:
        key = (min(a, b), max(a, b))
        if key not in middles:
            middles[key] = len(vertices)
            vertices.append((vertices[a] + vertices[b]) / 2)
        return middles[key]

    faces: list[tuple[int, ...]] = []
    for a, b, c in shape.faces:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        faces += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return Shape(np.array(vertices), tuple(faces))


def torus(around: int, across: int, radius: float = 1.0, thickness: float = 0.35) -> Shape:
    """A torus about the z axis, quads, `around` x `across`."""
    u, v = np.meshgrid(
        np.linspace(0, 2 * np.pi, around, endpoint=False),
        np.linspace(0, 2 * np.pi, across, endpoint=False),
        indexing="ij",
    )
    reach = radius + thickness * np.cos(v)
    vertices = np.stack([reach * np.cos(u), reach * np.sin(u), thickness * np.sin(v)], axis=2).reshape(-1, 3)
    faces = []
    for i, j in itertools.product(range(around), range(across)):
        i2, j2 = (i + 1) % around, (j + 1) % across
        faces.append((i * across + j, i2 * across + j, i2 * across + j2, i * across + j2))
    return Shape(vertices, tuple(faces))
