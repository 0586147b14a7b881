# SPDX-License-Identifier: GPL-3.0-or-later
"""All visible meshes as one surface, with the way back from its triangles to objects and faces."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

import stiv
from stiv.blender.scene.arrays import Floats, Indices, Singles
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.evaluations import SHOWN
from stiv.seams import Seams, find_seams

ROUNDING = 2.0**-19  # of an object's extent: Blender computes the copies of a seam one by one, in single precision

_Body = tuple[str, str, frozenset[str], frozenset[str]]  # object, mobility, evaluations, what it grows from


@dataclass(frozen=True)
class Element:
    """A face, loose edge or vertex of an object's evaluated mesh, or a strand, by its number. `kind` says which.

    evaluation: which one, where it is not the one shown now: "viewport" (Object Mode) or "render".
    """

    object: str
    kind: str
    number: int
    evaluation: str = SHOWN


@dataclass(frozen=True)
class Assembly:
    """One surface of several meshes.

    Attributes:
        meshes: in order.
        starts: first vertex of each mesh in the surface, and the number of vertices, (k + 1,).
        surface: connectivity and bodies; one body for each owner, mobility and set of evaluations.
        positions: world positions at the time of reading, (N, 3).
        seams: of each mesh, the vertices that are one in the surface; None: each is its own.
    """

    meshes: tuple[VisibleMesh, ...]
    starts: Indices
    surface: stiv.Surface
    positions: Floats
    seams: tuple[Seams | None, ...]

    def vertices(self, mesh: int) -> Indices:
        """The vertex of the surface for each vertex of a mesh, (n,)."""
        return _placed(self.seams[mesh], int(self.starts[mesh]), len(self.meshes[mesh].local))

    def range_of(self, mesh: int) -> Indices:
        """The vertices of the surface that belong to a mesh, each once."""
        return np.arange(self.starts[mesh], self.starts[mesh + 1], dtype=np.int32)

    def joined(self, mesh: int, points: Floats) -> Floats:
        """The points of a mesh, (n, 3), with those of a seam once."""
        return _joined(self.seams[mesh], points)

    def shifted_triangles(self, meshes: Sequence[VisibleMesh]) -> Indices:
        """Triangles of meshes with the same vertices over those of the surface, (F, 3)."""
        return _shifted([mesh.triangles for mesh in meshes], self.starts, self.seams, 3)

    def face(self, triangle: int) -> Element:
        """The face a triangle of the surface belongs to."""
        mesh, number = self._locate(triangle, [len(each.triangles) for each in self.meshes])
        return Element(mesh.owner.name, _kind(mesh, "face"), int(mesh.faces[number]), mesh.read_in)

    def loose_edge(self, edge: int) -> Element:
        """The edge that a loose edge of the surface is."""
        mesh, number = self._locate(edge, [len(each.loose_edges) for each in self.meshes])
        return Element(mesh.owner.name, _kind(mesh, "edge"), int(mesh.loose_numbers[number]), mesh.read_in)

    def vertex(self, vertex: int) -> Element:
        """The vertex that a vertex of the surface is."""
        place = int(np.searchsorted(self.starts, vertex, side="right")) - 1
        mesh, seams, number = self.meshes[place], self.seams[place], int(vertex - self.starts[place])
        if mesh.strands is not None:
            return Element(mesh.owner.name, "strand", int(mesh.strands[number]), mesh.read_in)
        first = number if seams is None else int(seams.first[number])
        return Element(mesh.owner.name, "vertex", mesh.vertex_number(first), mesh.read_in)

    def _locate(self, index: int, sizes: Sequence[int]) -> tuple[VisibleMesh, int]:
        ends = np.cumsum(sizes)
        mesh = int(np.searchsorted(ends, index, side="right"))
        return self.meshes[mesh], int(index - (ends[mesh] - sizes[mesh]))


def _kind(mesh: VisibleMesh, kind: str) -> str:
    return kind if mesh.strands is None else "strand"


def unjoined_triangles(meshes: Sequence[VisibleMesh]) -> Indices:
    """Triangles of meshes, one after the other, over the vertices of all as they are, (F, 3)."""
    starts = np.cumsum([0, *(len(mesh.local) for mesh in meshes)]).astype(np.int32)
    return _shifted([mesh.triangles for mesh in meshes], starts, (None,) * len(meshes), 3)


def mesh_seams(local: Singles, triangles: Indices) -> Seams | None:
    """The seams of a mesh in its own frame: (n, 3), (f, 3)."""
    return find_seams(local, triangles, ROUNDING)


def assemble_joined(meshes: Sequence[VisibleMesh], ignored: Sequence[tuple[str, str]] = ()) -> Assembly:
    """Put meshes into one surface as `assemble`: strands fixed, all else deformable, seams of each mesh joined."""
    seams = [mesh_seams(mesh.local, mesh.triangles) if mesh.strands is None else None for mesh in meshes]
    mobility = ["deformable" if mesh.strands is None else "fixed" for mesh in meshes]
    return assemble(meshes, mobility, (), ignored, seams)


def assemble(
    meshes: Sequence[VisibleMesh],
    mobility: Sequence[str],
    together: Sequence[frozenset[str]] = (),
    ignored: Sequence[tuple[str, str]] = (),
    seams: Sequence[Seams | None] = (),
) -> Assembly:
    """Put meshes into one surface.

    mobility: "fixed", "rigid" or "deformable", one for each mesh. together: names of objects that move as one, and are
    not tested against each other where rigid. ignored: pairs of names that are not tested. seams: vertices of each mesh
    that become one; empty: none do. Meshes that no evaluation shows together are not tested against each other, nor
    strands against what they grow from.
    """
    joins = tuple(seams) or (None,) * len(meshes)
    counts = [len(mesh.local) if each is None else len(each.first) for mesh, each in zip(meshes, joins, strict=True)]
    starts = np.cumsum([0, *counts]).astype(np.int32)
    bodies: dict[_Body, int] = {}
    body = [
        bodies.setdefault((mesh.owner.name, m, mesh.exists_in, mesh.rooted_in), len(bodies))
        for mesh, m in zip(meshes, mobility, strict=True)
    ]
    surface = stiv.Surface(
        _shifted([mesh.triangles for mesh in meshes], starts, joins, 3),
        int(starts[-1]),
        _shifted([mesh.loose_edges for mesh in meshes], starts, joins, 2),
        np.repeat(np.array(body, np.int32), np.diff(starts)),
        [stiv.Body(name, kind) for name, kind, *_ in bodies] or None,
        _ignored(bodies, together, ignored),
    )
    world = [_joined(each, mesh.world()) for mesh, each in zip(meshes, joins, strict=True)]
    return Assembly(tuple(meshes), starts, surface, np.concatenate([np.empty((0, 3)), *world]), joins)


def _shifted(rows: Sequence[Indices], starts: Indices, seams: Sequence[Seams | None], width: int) -> Indices:
    """Rows of vertices of several meshes over the vertices of all."""
    moved = [
        (each if joins is None else joins.index[each]) + start
        for each, start, joins in zip(rows, starts[:-1], seams, strict=True)
    ]
    return np.concatenate([np.empty((0, width), np.int32), *moved]).astype(np.int32)


def _placed(seams: Seams | None, start: int, count: int) -> Indices:
    return (np.arange(count, dtype=np.int32) if seams is None else seams.index) + np.int32(start)


def _joined(seams: Seams | None, points: Floats) -> Floats:
    return points if seams is None else points[seams.first]


def _ignored(
    bodies: Mapping[_Body, int], together: Sequence[frozenset[str]], ignored: Sequence[tuple[str, str]]
) -> list[tuple[int, int]]:
    pairs = set()
    for (first, kind, here, roots), a in bodies.items():
        for (second, other, there, grown), b in bodies.items():
            if b < a:
                continue
            rigid = kind == other == "rigid" and any(first in names and second in names for names in together)
            rooted = first in grown or second in roots
            if rigid or rooted or not here & there or (first, second) in ignored or (second, first) in ignored:
                pairs.add((a, b))
    return sorted(pairs)
