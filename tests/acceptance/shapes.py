# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed shapes of plain formulas."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


def grid_faces(rows: int, columns: int) -> Integers:
    """Return the faces of a grid that closes on itself in both directions."""
    i, j = (k.ravel() for k in np.mgrid[:rows, :columns])
    a, b = i * columns + j, (i + 1) % rows * columns + j
    c, d = (i + 1) % rows * columns + (j + 1) % columns, i * columns + (j + 1) % columns
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def torus(rows: int = 24, columns: int = 12, radius: float = 2, tube: float = 0.5) -> tuple[Floats, Integers]:
    u, v = (2 * np.pi * k.ravel() / n for k, n in zip(np.mgrid[:rows, :columns], (rows, columns), strict=True))
    ring = radius + tube * np.cos(v)
    return np.stack([ring * np.cos(u), ring * np.sin(u), tube * np.sin(v)], axis=1), grid_faces(rows, columns)


def sphere(rows: int = 12, columns: int = 16) -> tuple[Floats, Integers]:
    """Return a unit sphere; each pole is a ring of coincident corners merged into one vertex."""
    u, v = np.meshgrid(np.linspace(0, np.pi, rows + 1)[1:-1], 2 * np.pi * np.arange(columns) / columns, indexing="ij")
    body = np.stack([np.sin(u) * np.cos(v), np.sin(u) * np.sin(v), np.cos(u)], axis=-1).reshape(-1, 3)
    faces = grid_faces(rows - 1, columns)
    faces = faces[(faces.max(axis=1) - faces.min(axis=1)) < (rows - 2) * columns]
    top, bottom, j = len(body), len(body) + 1, np.arange(columns)
    last = (rows - 2) * columns
    caps = [
        [np.full(columns, top), j, (j + 1) % columns],
        [last + (j + 1) % columns, last + j, np.full(columns, bottom)],
    ]
    vertices = np.concatenate([body, [[0, 0, 1], [0, 0, -1]]])
    return vertices, np.concatenate([faces, *(np.stack(cap, axis=1) for cap in caps)])


def joined(*parts: tuple[Floats, Integers]) -> tuple[Floats, Integers]:
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in parts)])
    faces = [part[1] + start for part, start in zip(parts, starts, strict=False)]
    return np.concatenate([vertices for vertices, _ in parts]), np.concatenate(faces)


def two_spheres(distance: float) -> tuple[Floats, Integers]:
    """Return two unit spheres, the second above the first."""
    vertices, faces = sphere()
    return joined((vertices, faces), (vertices + np.array([0, 0, distance]), faces))


def linked_tori(shift: float = 0.0) -> tuple[Floats, Integers]:
    """Return two rings linked as in a chain; the second moved by `shift` along x."""
    vertices, faces = torus()
    return joined((vertices, faces), (vertices[:, [0, 2, 1]] + np.array([2 + shift, 0, 0]), faces))
