# SPDX-License-Identifier: GPL-3.0-or-later
"""All visible meshes as one surface, with lookup from its triangles to objects and faces."""

from bisect import bisect_right
from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate

import numpy as np

import stiv
from stiv.blender.scene.arrays import Flags, Floats, Indices, Singles
from stiv.blender.scene.elements import Element, FacePairs
from stiv.blender.scene.evaluated_scene import VisibleMesh
from stiv.blender.scene.shared_surface import make_surface
from stiv.blender.scene.static_mesh import StaticMesh
from stiv.seams import Seams, find_seams

ROUNDING = 2.0**-19  # of an object's extent; Blender computes the copies of a seam separately, in single precision

_Body = tuple[str, str, frozenset[str], frozenset[str], int]  # object, mobility, evaluations, roots of strands, part
Part = tuple[str, frozenset[str], int]
"""A part of a mesh: the name of its object, the evaluations that show it, and its number."""


@dataclass(frozen=True)
class Assembly:
    """One surface of several meshes.

    Attributes:
        meshes: in order.
        starts: first vertex of each mesh in the surface, followed by the number of vertices, (k + 1,).
        surface: connectivity and bodies; one body for each owner, mobility and set of evaluations.
        positions: world positions when the scene was read, (N, 3).
        seams: for each mesh, the vertices that are merged in the surface; None if none are.
        obstacles: beside the surface. Their triangles are numbered after those of the surface.
    """

    meshes: tuple[VisibleMesh, ...]
    starts: Indices
    surface: stiv.Surface
    positions: Floats
    seams: tuple[Seams | None, ...]
    obstacles: tuple[StaticMesh, ...] = ()

    def vertices(self, mesh: int) -> Indices:
        """Vertex of the surface for each vertex of a mesh, (n,)."""
        return _surface_vertices(self.seams[mesh], int(self.starts[mesh]), len(self.meshes[mesh].local))

    def vertices_of(self, meshes: Sequence[int]) -> Indices:
        """Vertices of the surface that belong to meshes, without duplicates on seams."""
        rows = [np.arange(self.starts[k], self.starts[k + 1], dtype=np.int32) for k in meshes]
        return np.concatenate([np.empty(0, np.int32), *rows])

    def merge_seams(self, mesh: int, points: Floats) -> Floats:
        """Points of a mesh, (n, 3), without duplicates on seams."""
        return _merge_seams(self.seams[mesh], points)

    def renumbered_triangles(self, meshes: Sequence[VisibleMesh]) -> Indices:
        """Triangles of meshes with the same vertices, with vertex numbers of the surface, (F, 3)."""
        return _renumber([mesh.triangles for mesh in meshes], self.starts, self.seams, 3)

    def face(self, triangle: int) -> Element:
        """The face of a triangle of the surface or an obstacle."""
        number = triangle - len(self.surface.triangles)
        if number >= 0:
            return self._element_beside(number)
        mesh, number = self._locate(triangle, self._triangle_ends)
        return Element(mesh.owner.name, _kind(mesh, "face"), int(mesh.faces[number]), mesh.read_from, mesh.part)

    def face_pairs(self, pairs: Indices) -> tuple[FacePairs, Indices]:
        """The pairs of faces of pairs of triangles, (k, 2), of the surface or an obstacle.

        Each pair occurs once, in the order and with the first face of its first pair of triangles. Also returns, for
        each pair of triangles, the number of its pair of faces, (k,).
        """
        triangles, places = np.unique(pairs, return_inverse=True)
        owners, owner, number = self._owned_faces(triangles)
        places = places.reshape(-1, 2)
        return FacePairs.merged(owners, owner[places], number[places])

    def loose_edge(self, edge: int) -> Element:
        """The edge of a loose edge of the surface."""
        mesh, number = self._locate(edge, self._loose_edge_ends)
        return Element(mesh.owner.name, _kind(mesh, "edge"), int(mesh.loose_numbers[number]), mesh.read_from)

    def vertex(self, vertex: int) -> Element:
        """The element of a vertex of the surface."""
        place = int(np.searchsorted(self.starts, vertex, side="right")) - 1
        mesh, seams, number = self.meshes[place], self.seams[place], int(vertex - self.starts[place])
        if mesh.strands is not None:
            return Element(mesh.owner.name, "strand", int(mesh.strands[number]), mesh.read_from)
        first = number if seams is None else int(seams.first[number])
        return Element(mesh.owner.name, "vertex", mesh.vertex_number(first), mesh.read_from, mesh.part)

    def _owned_faces(self, triangles: Indices) -> tuple[list[Element], Indices, Indices]:
        """Owners of faces (see FacePairs), and the owner and the face of each of some ascending triangles, (n,)."""
        owners: dict[Element, int] = {}  # some meshes show the same faces
        owner, number = [np.empty(0, np.int32)], [np.empty(0, np.int32)]
        for element, numbers in self._elements_of(triangles):
            owner.append(np.full(len(numbers), owners.setdefault(element, len(owners)), np.int32))
            number.append(numbers)
        return list(owners), np.concatenate(owner), np.concatenate(number)

    def _elements_of(self, triangles: Indices) -> Iterator[tuple[Element, Indices]]:
        """The elements of ascending triangles, (n,), in their order: those of one mesh and kind together."""
        begin = 0
        for mesh, end in zip(self.meshes, np.searchsorted(triangles, self._triangle_ends).tolist(), strict=True):
            if end > begin:
                kind = Element(mesh.owner.name, _kind(mesh, "face"), 0, mesh.read_from, mesh.part)
                yield kind, self._triangle_faces[triangles[begin:end]]
            begin = end
        first = len(self.surface.triangles)
        for static in self.obstacles:
            own = triangles[begin:] - np.int32(first)
            end = int(np.searchsorted(own, static.obstacle.triangle_count))
            yield from static.elements(own[:end])
            begin, first = begin + end, first + static.obstacle.triangle_count

    @cached_property
    def _triangle_faces(self) -> Indices:
        return np.concatenate([np.empty(0, np.int32), *(each.faces for each in self.meshes)])

    def _element_beside(self, number: int) -> Element:
        """The element of a triangle of all obstacles."""
        for static in self.obstacles:
            if number < static.obstacle.triangle_count:
                return static.element(number)
            number -= static.obstacle.triangle_count
        raise IndexError("no obstacle has this triangle")

    @cached_property
    def _triangle_ends(self) -> list[int]:
        return list(accumulate(len(each.triangles) for each in self.meshes))

    @cached_property
    def _loose_edge_ends(self) -> list[int]:
        return list(accumulate(len(each.loose_edges) for each in self.meshes))

    def _locate(self, index: int, ends: Sequence[int]) -> tuple[VisibleMesh, int]:
        mesh = bisect_right(ends, index)
        return self.meshes[mesh], index - (ends[mesh - 1] if mesh else 0)


def _kind(mesh: VisibleMesh, kind: str) -> str:
    return kind if mesh.strands is None else "strand"


def unmerged_triangles(meshes: Sequence[VisibleMesh]) -> Indices:
    """Triangles of all meshes with vertex numbers of the stacked meshes, seams not merged, (F, 3)."""
    starts = np.cumsum([0, *(len(mesh.local) for mesh in meshes)]).astype(np.int32)
    return _renumber([mesh.triangles for mesh in meshes], starts, (None,) * len(meshes), 3)


def mesh_seams(local: Singles, triangles: Indices) -> Seams | None:
    """Seams of a mesh in its own frame, from positions (n, 3) and triangles (f, 3)."""
    return find_seams(local, triangles, ROUNDING)


def assemble_against_others(
    meshes: Sequence[VisibleMesh], moving: frozenset[str], ignored: Sequence[tuple[str, str]] = ()
) -> tuple[Assembly, Flags]:
    """Assemble meshes so that only pairs of a moving and a resting object meet; also flags the moving vertices, (N,).

    moving: names of the objects that move together. ignored: pairs of names that are not tested.
    """
    moves = [mesh.owner.name in moving for mesh in meshes]
    assembly = assemble(meshes, ["rigid" if each else "fixed" for each in moves], (moving,), ignored)
    return assembly, np.repeat(np.array(moves, np.bool_), np.diff(assembly.starts))


def assemble_with_seams(
    meshes: Sequence[VisibleMesh], ignored: Sequence[tuple[str, str]] = (), moving: Collection[str] | None = None
) -> Assembly:
    """Assemble meshes with merged seams: strands fixed, all other meshes deformable.

    moving: names of the objects that are tested, also against all others, which are fixed; None: all objects.
    """
    deforms = [mesh.strands is None and (moving is None or mesh.owner.name in moving) for mesh in meshes]
    pairs = list(zip(meshes, deforms, strict=True))
    seams = [mesh_seams(mesh.local, mesh.triangles) if tested else None for mesh, tested in pairs]
    mobility = ["deformable" if tested else "fixed" for tested in deforms]
    return assemble(meshes, mobility, (), ignored, seams)


def assemble(
    meshes: Sequence[VisibleMesh],
    mobility: Sequence[str],
    together: Sequence[frozenset[str]] = (),
    ignored: Sequence[tuple[str, str]] = (),
    seams: Sequence[Seams | None] = (),
    untested: Collection[tuple[Part, Part]] = (),
) -> Assembly:
    """Assemble meshes into one surface.

    mobility: "fixed", "rigid" or "deformable" for each mesh. together: sets of names of objects that move together;
    rigid ones are not tested against each other. ignored: pairs of names that are not tested. seams: vertices to merge
    in each mesh; empty for none. untested: parts that are not tested against each other.

    Meshes that no evaluation shows together are not tested against each other, nor strands against their roots.
    """
    joins = tuple(seams) or (None,) * len(meshes)
    counts = [len(mesh.local) if each is None else len(each.first) for mesh, each in zip(meshes, joins, strict=True)]
    starts = np.cumsum([0, *counts]).astype(np.int32)
    bodies: dict[_Body, int] = {}
    body = [
        bodies.setdefault((mesh.owner.name, m, mesh.shown_in, mesh.rooted_in, mesh.part), len(bodies))
        for mesh, m in zip(meshes, mobility, strict=True)
    ]
    surface = make_surface(
        _renumber([mesh.triangles for mesh in meshes], starts, joins, 3),
        int(starts[-1]),
        _renumber([mesh.loose_edges for mesh in meshes], starts, joins, 2),
        np.repeat(np.array(body, np.int32), np.diff(starts)),
        [stiv.Body(name, kind) for name, kind, *_ in bodies] or None,
        _ignored_bodies(bodies, together, ignored, frozenset(untested)),
    )
    world = [_merge_seams(each, mesh.world()) for mesh, each in zip(meshes, joins, strict=True)]
    return Assembly(tuple(meshes), starts, surface, np.concatenate([np.empty((0, 3)), *world]), joins)


def _renumber(rows: Sequence[Indices], starts: Indices, seams: Sequence[Seams | None], width: int) -> Indices:
    """Rows of vertices of each mesh, with vertex numbers of the surface."""
    moved = [
        (each if joins is None else joins.index[each]) + start
        for each, start, joins in zip(rows, starts[:-1], seams, strict=True)
    ]
    return np.concatenate([np.empty((0, width), np.int32), *moved]).astype(np.int32)


def _surface_vertices(seams: Seams | None, start: int, count: int) -> Indices:
    return (np.arange(count, dtype=np.int32) if seams is None else seams.index) + np.int32(start)


def _merge_seams(seams: Seams | None, points: Floats) -> Floats:
    return points if seams is None else points[seams.first]


def _ignored_bodies(
    bodies: Mapping[_Body, int],
    together: Sequence[frozenset[str]],
    ignored: Sequence[tuple[str, str]],
    untested: frozenset[tuple[Part, Part]],
) -> list[tuple[int, int]]:
    """Pairs of bodies that are not tested, ascending. There can be thousands of bodies, so each rule lists its own."""
    by_name, by_part = defaultdict[str, list[int]](list), defaultdict[Part, list[int]](list)
    shown = defaultdict[frozenset[str], list[int]](list)
    for (name, _, here, _, part), number in bodies.items():
        for listed in (by_name[name], by_part[name, here, part], shown[here]):
            listed.append(number)
    rigid = {number: name for (name, kind, *_), number in bodies.items() if kind == "rigid"}
    groups = [[number for number, name in rigid.items() if name in names] for names in together]
    both = [
        *((group, group) for group in groups),
        *((by_name[root], [number]) for (*_, roots, _), number in bodies.items() for root in roots),
        *((by_part[first], by_part[second]) for first, second in untested),
        *((by_name[first], by_name[second]) for first, second in ignored),
        *((some, others) for here, some in shown.items() for there, others in shown.items() if not here & there),
    ]
    return sorted({(min(a, b), max(a, b)) for first, second in both for a in first for b in second})
