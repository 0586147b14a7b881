# SPDX-License-Identifier: GPL-3.0-or-later
"""All visible meshes as one surface, with the way back from its triangles to objects and faces."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

import stiv
from stiv.blender.arrays import Floats, Indices
from stiv.blender.evaluated_scene import VisibleMesh


@dataclass(frozen=True)
class Element:
    """A face, loose edge or vertex of an object's evaluated mesh, by its number there. `kind` says which."""

    object: str
    kind: str
    number: int


@dataclass(frozen=True)
class Assembly:
    """One surface of several meshes.

    Attributes:
        meshes: in order.
        starts: first vertex of each mesh, and the number of vertices, (k + 1,).
        surface: connectivity and bodies; one body for each owner and mobility.
        positions: world positions at the time of reading, (N, 3).
    """

    meshes: tuple[VisibleMesh, ...]
    starts: Indices
    surface: stiv.Surface
    positions: Floats

    def vertices(self, mesh: int) -> Indices:
        """The vertices of a mesh in the surface."""
        return np.arange(self.starts[mesh], self.starts[mesh + 1], dtype=np.int32)

    def face(self, triangle: int) -> Element:
        """The face a triangle of the surface belongs to."""
        mesh, number = self._locate(triangle, [len(each.triangles) for each in self.meshes])
        return Element(mesh.owner.name, "face", int(mesh.faces[number]))

    def loose_edge(self, edge: int) -> Element:
        """The edge that a loose edge of the surface is."""
        mesh, number = self._locate(edge, [len(each.loose_edges) for each in self.meshes])
        return Element(mesh.owner.name, "edge", int(mesh.loose_numbers[number]))

    def vertex(self, vertex: int) -> Element:
        """The vertex that a vertex of the surface is."""
        mesh, number = self._locate(vertex, [len(each.local) for each in self.meshes])
        return Element(mesh.owner.name, "vertex", mesh.vertex_number(number))

    def _locate(self, index: int, sizes: Sequence[int]) -> tuple[VisibleMesh, int]:
        ends = np.cumsum(sizes)
        mesh = int(np.searchsorted(ends, index, side="right"))
        return self.meshes[mesh], int(index - (ends[mesh] - sizes[mesh]))


def assemble(
    meshes: Sequence[VisibleMesh],
    mobility: Sequence[str],
    together: Sequence[frozenset[str]] = (),
    ignored: Sequence[tuple[str, str]] = (),
) -> Assembly:
    """Put meshes into one surface.

    mobility: "fixed", "rigid" or "deformable", one for each mesh. together: names of objects that move as one, and are
    not tested against each other where rigid. ignored: pairs of names that are not tested.
    """
    starts = np.cumsum([0, *(len(mesh.local) for mesh in meshes)]).astype(np.int32)
    bodies: dict[tuple[str, str], int] = {}
    body = [bodies.setdefault((mesh.owner.name, m), len(bodies)) for mesh, m in zip(meshes, mobility, strict=True)]
    surface = stiv.Surface(
        shifted_triangles([mesh.triangles for mesh in meshes], starts),
        int(starts[-1]),
        _shifted([mesh.loose_edges for mesh in meshes], starts, 2),
        np.repeat(np.array(body, np.int32), np.diff(starts)),
        [stiv.Body(name, kind) for name, kind in bodies] or None,
        _ignored(bodies, together, ignored),
    )
    positions = np.concatenate([np.empty((0, 3)), *(mesh.world() for mesh in meshes)])
    return Assembly(tuple(meshes), starts, surface, positions)


def shifted_triangles(triangles: Sequence[Indices], starts: Indices) -> Indices:
    """Triangles of several meshes over the vertices of all, (F, 3)."""
    return _shifted(triangles, starts, 3)


def _shifted(rows: Sequence[Indices], starts: Indices, width: int) -> Indices:
    moved = [each + start for each, start in zip(rows, starts, strict=False)]
    return np.concatenate([np.empty((0, width), np.int32), *moved]).astype(np.int32)


def _ignored(
    bodies: Mapping[tuple[str, str], int], together: Sequence[frozenset[str]], ignored: Sequence[tuple[str, str]]
) -> list[tuple[int, int]]:
    pairs = set()
    for (first, kind), a in bodies.items():
        for (second, other), b in bodies.items():
            if b < a:
                continue
            rigid = kind == other == "rigid" and any(first in names and second in names for names in together)
            if rigid or (first, second) in ignored or (second, first) in ignored:
                pairs.add((a, b))
    return sorted(pairs)
