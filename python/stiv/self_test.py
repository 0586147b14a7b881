# SPDX-License-Identifier: GPL-3.0-or-later
"""The self-test: hashes of edits and intersection tests that have the same bits on every machine."""

import hashlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stiv import _native
from stiv.arrays import Floats, Indices
from stiv.deformation import identity
from stiv.edit_session import edit
from stiv.intersections import find_intersections
from stiv.surface import Surface

EDITS = 40
TRIANGLE_PAIRS = 100_000
EXPECTED_EDITS = "0b6f4e21fc2a559a"
EXPECTED_INTERSECTIONS = "ea94f96df0f5ceb3"


@dataclass(frozen=True)
class SelfTest:
    """The hashes of this machine: of the controls after 40 edits, and of the pairs among 100,000 that intersect."""

    edits: str
    intersections: str
    vectors: str  # the vector instructions in use, such as "avx2"

    @property
    def passed(self) -> bool:
        """Do both hashes have the expected values?"""
        return (self.edits, self.intersections) == (EXPECTED_EDITS, EXPECTED_INTERSECTIONS)


def self_test() -> SelfTest:
    """Run the self-test, in about a second."""
    edits = [_edit(number) for number in range(EDITS)]
    return SelfTest(_hash(edits), _hash([_intersecting_pairs()]), _native.vector_target().name)


def _edit(number: int) -> Floats:
    """A sheet, bent differently by each number, pushed through another one: the accepted controls."""
    side = 6 + number % 5
    sheet, faces = _sheet(side)
    vertices = np.vstack([sheet, sheet + (0.0, 0.0, 0.25)])
    goal = vertices.copy()
    upper = goal[len(sheet) :]
    upper[:, 2] += 0.25 * upper[:, 0] * upper[:, number % 2] - 0.05 * (number % 10 + 1)
    surface = Surface(np.vstack([faces, faces + len(sheet)]), len(vertices))
    return edit(surface, identity(len(vertices)), vertices, goal).controls


def _sheet(side: int) -> tuple[Floats, Indices]:
    """A square of side 2 with `side` vertices along each edge, in triangles."""
    along = np.linspace(-1.0, 1.0, side)
    x, y = np.meshgrid(along, along, indexing="ij")
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
    quads = np.column_stack([corner, corner + side, corner + side + 1, corner + 1])
    vertices = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    return vertices, np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int32)


def _intersecting_pairs() -> NDArray[np.int32]:
    """Pairs of nearly coplanar triangles, far from one another: those that intersect.

    Coordinates are multiples of 2^-30, so that no library of random numbers or functions affects them.
    """
    count = 6 * TRIANGLE_PAIRS
    state = np.arange(1, 3 * count + 1, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    state ^= state >> np.uint64(31)
    state *= np.uint64(0xBF58476D1CE4E5B9)
    points = ((state >> np.uint64(34)).astype(np.float64) * 2.0**-30).reshape(-1, 6, 3)
    points[:, :, 2] = np.round(points[:, :, 2] * 4.0) * 2.0**-30
    points[:, :, 0] += 4.0 * np.arange(TRIANGLE_PAIRS)[:, None]
    triangles = np.arange(count, dtype=np.int32).reshape(-1, 3)
    return np.asarray(find_intersections(points.reshape(-1, 3), Surface(triangles, count)), np.int32)


def _hash(arrays: list[NDArray[np.float64]] | list[NDArray[np.int32]]) -> str:
    digest = hashlib.sha256()
    for array in arrays:
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:16]
