# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaves out loose edges and vertices that touch their own object: only pairs of triangles can be excluded."""

from collections import Counter
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace

import numpy as np

import stiv
from stiv.blender.scene.arrays import Flags, Indices
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.elements import Element
from stiv.blender.scene.exclusions import needs_no_decision
from stiv.blender.scene.face_pairs import has_loose_elements
from stiv.blender.scene.message_fitting import fit_message

_ROUNDING = 64  # units in the last place that positions may differ from stored ones


@dataclass(frozen=True)
class LooseParts:
    """Loose elements of an assembly.

    Attributes:
        edges: numbers of loose edges, (k,), ascending.
        vertices: the vertices, (m,), ascending, that are in no triangle and in no other loose edge.
    """

    edges: Indices
    vertices: Indices


def find_touching_parts(assembly: Assembly, together: Collection[str], threads: int = 0) -> LooseParts:
    """The loose edges and vertices that cut or touch only faces which need no decision: see `needs_no_decision`.

    Rounding decides whether those that touch cut, so each motion may change it.
    """
    surface = assembly.surface
    if not has_loose_elements(surface):
        return LooseParts(np.empty(0, np.int32), np.empty(0, np.int32))
    edges, vertices = stiv.find_loose_intersections(
        assembly.positions, surface, distance=_rounding(assembly), threads=threads
    )
    touching_edges = _touching(edges, assembly.loose_edge, assembly, together)
    used = np.zeros(surface.vertex_count, np.bool_)
    used[surface.triangles] = used[np.delete(surface.loose_edges, touching_edges, axis=0)] = True
    ends = np.union1d(surface.loose_edges[touching_edges], _touching(vertices, assembly.vertex, assembly, together))
    return LooseParts(touching_edges, ends[~used[ends]].astype(np.int32))


def _rounding(assembly: Assembly) -> float:
    """How far rounding can move a stored vertex of a mesh with loose elements; objects may be far from their origin."""
    largest = 0.0
    for mesh in assembly.meshes:
        if len(mesh.loose_edges) or len(np.unique(mesh.triangles)) < len(mesh.local):
            largest = max(largest, float(abs(mesh.world()).max()) + float(abs(mesh.matrix[:3, 3]).max()))
    return _ROUNDING * float(np.spacing(np.float32(largest)))


def _touching(
    pairs: Indices, element: Callable[[int], Element], assembly: Assembly, together: Collection[str]
) -> Indices:
    """The first numbers of pairs with triangles, (k, 2), if none of their pairs needs a decision."""
    undecided = {
        number
        for number, triangle in pairs.tolist()
        if not needs_no_decision(element(number), assembly.face(triangle), together)
    }
    return np.setdiff1d(pairs[:, 0], np.array(sorted(undecided), np.int32))


def without_loose_parts(assembly: Assembly, parts: LooseParts) -> Assembly:
    """The assembly without some loose edges. The vertices form bodies of their own, which no object tests."""
    if not len(parts.edges) and not len(parts.vertices):
        return assembly
    tested = np.ones(len(assembly.surface.loose_edges), np.bool_)
    tested[parts.edges] = False
    meshes, first = [], 0
    for mesh in assembly.meshes:
        own = tested[first : first + len(mesh.loose_edges)]
        first += len(mesh.loose_edges)
        meshes.append(replace(mesh, loose_edges=mesh.loose_edges[own], loose_numbers=mesh.loose_numbers[own]))
    return replace(assembly, meshes=tuple(meshes), surface=_without(assembly.surface, tested, parts.vertices))


def _without(old: stiv.Surface, tested: Flags, vertices: Indices) -> stiv.Surface:
    bodies, vertex_body = list(old.bodies), old.vertex_body.copy()
    ignored = [(int(a), int(b)) for a, b in old.ignored]
    for body in np.unique(old.vertex_body[vertices]).tolist():
        own = vertices[old.vertex_body[vertices] == body]
        vertex_body[own] = len(bodies)
        bodies.append(old.bodies[body])
        ignored += [(number, len(bodies) - 1) for number in range(len(bodies))]
    return stiv.Surface(
        old.triangles, old.vertex_count, old.loose_edges[tested], vertex_body, bodies, ignored, old.flip_faces
    )


def loose_part_notes(assembly: Assembly, parts: LooseParts) -> tuple[str, ...]:
    """A note for each object that has some of the parts: how many are left out."""
    single = np.setdiff1d(parts.vertices, assembly.surface.loose_edges[parts.edges]).tolist()
    names = [assembly.loose_edge(edge).object for edge in parts.edges.tolist()]
    names += [assembly.vertex(vertex).object for vertex in single]
    return tuple(_note(name, count) for name, count in sorted(Counter(names).items()))


def _note(name: str, count: int) -> str:
    if count == 1:
        return fit_message("{}: 1 loose edge or vertex touches it and is not tested", name)
    return fit_message("{}" + f": {count:,} loose edges or vertices touch it and are not tested", name)
