# SPDX-License-Identifier: GPL-3.0-or-later
"""Several Loop subdivision surfaces, moved by their cages or rigidly, in successive stages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import stiv

from ..shape import Shape, joined
from .session import Array, Edit, Stage, surface_of


@dataclass(frozen=True)
class Part:
    """A triangle cage and its Loop subdivision surface; with `levels` 0, the cage itself."""

    cage: Shape
    levels: int
    deformation: stiv.Deformation
    triangles: NDArray[np.int32]

    def surface(self, cage: Array) -> Shape:
        """The subdivided surface for these positions (m, 3) of the cage's vertices."""
        return Shape(self.deformation.surface(cage), tuple(map(tuple, self.triangles.tolist())))


def part(cage: Shape, levels: int) -> Part:
    """A part with a triangle cage; positions are in single precision, as stored in a scene."""
    stored = Shape(cage.vertices.astype(np.float32).astype(float), cage.faces)
    if levels == 0:
        return Part(stored, 0, stiv.identity(len(stored.vertices)), stored.triangles())
    deformation, triangles = stiv.loop(stiv.Cage.of_faces(stored.faces), levels)
    return Part(stored, levels, deformation, triangles)


class Parts:
    """Named parts and the current positions of their cages."""

    def __init__(self, parts: Mapping[str, Part]) -> None:
        self.parts = dict(parts)
        self.cages = {name: item.cage.vertices for name, item in parts.items()}

    def shapes(self) -> dict[str, Shape]:
        """The current subdivided surfaces."""
        return {name: item.surface(self.cages[name]) for name, item in self.parts.items()}

    def pairs(self, names: Sequence[str] = ()) -> int:
        """Number of intersecting pairs of triangles of these parts (default: all), by the exact test."""
        shapes = self.shapes()
        whole = joined([shapes[name] for name in names or shapes])
        return len(stiv.find_intersections(whole.vertices, whole.triangles()))

    def block(self, movers: Sequence[str], name: str) -> NDArray[np.int64]:
        """The rows of the controls of one part among those that a stage moves."""
        sizes = np.cumsum([0, *(len(self.cages[mover]) for mover in movers)])
        place = list(movers).index(name)
        return np.arange(sizes[place], sizes[place + 1])

    def by_cages(
        self, name: str, movers: Sequence[str], edits: Sequence[Edit], response: Mapping[str, float] | None = None
    ) -> Stage:
        """A stage that moves the cages of `movers` and fixes the others; `response` gives the weights of a part."""
        surface, start = surface_of(self.shapes(), {other: "fixed" for other in self.parts if other not in movers})
        moved = [(self.parts[mover].deformation, self._vertices(surface, mover)) for mover in movers]
        controls = np.concatenate([self.cages[mover] for mover in movers])
        weights = np.concatenate(
            [np.full(len(self.cages[mover]), (response or {}).get(mover, 1.0)) for mover in movers]
        )
        options = {"weights": weights} if response else {}
        return Stage(name, surface, stiv.concatenate(moved, start), controls, tuple(edits), options)

    def rigidly(self, name: str, mover: str, edits: Sequence[Edit]) -> Stage:
        """A stage that moves one part as a rigid body; its controls are centre and rotation vector."""
        mobility = {other: "rigid" if other == mover else "fixed" for other in self.parts}
        surface, start = surface_of(self.shapes(), mobility)
        vertices = self._vertices(surface, mover)
        body = start[vertices]
        deformation = stiv.concatenate([(stiv.rigid(body), vertices)], start)
        return Stage(name, surface, deformation, stiv.rigid_rest_controls(body), tuple(edits))

    def take_cages(self, movers: Sequence[str], controls: Array) -> None:
        """Move the cages to the result of a stage with cages."""
        for mover in movers:
            self.cages[mover] = controls[self.block(movers, mover)]

    def take_rigid(self, mover: str, controls: Array) -> None:
        """Move a cage to the result of a rigid stage; subdivision commutes with rigid motions."""
        centre = self.shapes()[mover].vertices.mean(axis=0)
        arms = self.cages[mover] - centre
        moved = controls[0] + arms @ _rotation(controls[1]).T
        self.cages[mover] = moved.astype(np.float32).astype(float)

    def _vertices(self, surface: stiv.Surface, name: str) -> NDArray[np.int64]:
        return np.flatnonzero(surface.vertex_body == list(self.parts).index(name))


def _rotation(vector: Array) -> Array:
    """The rotation (3, 3) by |vector| radians about a vector (Rodrigues' formula)."""
    angle = float(np.linalg.norm(vector))
    if angle == 0:
        return np.eye(3)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    result: Array = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return result
