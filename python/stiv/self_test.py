# SPDX-License-Identifier: GPL-3.0-or-later
"""The self-test: hashes of edits and intersection tests that have the same bits on every machine."""

import hashlib
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stiv import _native
from stiv.arrays import Floats, Indices
from stiv.deformation import Deformation, concatenate, identity, rigid, rigid_rest_controls
from stiv.edit_session import EditOptions, edit
from stiv.handles import arap
from stiv.intersections import find_intersections
from stiv.subdivision import Cage, catmull_clark
from stiv.surface import Surface

EDITS = 40
TRIANGLE_PAIRS = 100_000
EXPECTED_EDITS = "512c1afd65afd2f0"
EXPECTED_INTERSECTIONS = "ea94f96df0f5ceb3"

# Corners are extraordinary vertices: their weights depend on sines and cosines.
_BOX = np.array([[x, y, z] for z in (-1.0, 1.0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
_BOX_FACES = [[3, 2, 1, 0], [4, 5, 6, 7], [1, 5, 4, 0], [2, 6, 5, 1], [3, 7, 6, 2], [0, 4, 7, 3]]


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
    """Run the self-test, in about two seconds."""
    edits = [_edit(number) for number in range(EDITS)]
    return SelfTest(_hash(edits), _hash([_intersecting_pairs()]), _native.vector_target().name)


def _edit(number: int) -> Floats:
    """One of four deformations, pushed into a wall by a different path for each number: the accepted controls."""
    ball = Cage.of_faces(_BOX_FACES)
    if number % 4 == 0:
        rest, faces = _sheet(6 + number // 4)
        moved, controls = identity(len(rest)), rest
    elif number % 4 == 1:
        deformation, faces = catmull_clark(ball, 2)
        rest = deformation.surface(_BOX)
        moved, controls = rigid(rest), rigid_rest_controls(rest)
    elif number % 4 == 2:
        moved, faces = catmull_clark(ball, 2 + number % 3 // 2)
        controls = _BOX
    else:
        rest, faces = _sheet(8)
        handles = np.arange(number % 5, len(rest), 7)
        moved, controls = arap(rest, faces, handles), rest[handles]
    return _pushed(moved, controls, faces, number)


def _pushed(moved: Deformation, controls: Floats, faces: Indices, number: int) -> Floats:
    """Controls after an edit that pushes a surface through a wall below it, and bends or turns it."""
    surface = moved.surface(controls)
    wall, wall_faces = _sheet(5)
    count, free = len(surface), len(controls)
    positions = np.vstack([surface, 2.0 * wall - (0.0, 0.0, 1.3)])
    both = concatenate([(moved, np.arange(count)), (identity(len(wall)), np.arange(count, len(positions)))], positions)
    start = np.vstack([controls, positions[count:]])
    goal = start.copy()
    goal[:free] += 0.25 * controls[:, [1, 2, 0]] * controls - (0.0, 0.0, 1.4 + 0.05 * number)
    goal[free - 1] += (0.7, 0.1 * (number % 7), 0.2)  # of a rigid body, its rotation
    weights = np.r_[np.ones(free), np.zeros(len(wall))]
    triangles = Surface(np.vstack([faces, wall_faces + count]), len(positions))
    return edit(triangles, both, start, goal, EditOptions(weights=weights)).controls


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
