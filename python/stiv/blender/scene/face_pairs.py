# SPDX-License-Identifier: GPL-3.0-or-later
"""Names the elements of objects in intersecting triangles and contacts."""

from __future__ import annotations

import numpy as np

import stiv
from stiv.blender.scene.arrays import Floats, Indices
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.elements import Element, FacePair, FacePairs


def find_face_pairs(assembly: Assembly, q: Floats, threads: int = 0, intersecting: Indices | None = None) -> FacePairs:
    """All intersections at positions `q`, (N, 3), without duplicates, including those of loose edges and vertices.

    intersecting: pairs of triangles, (k, 2), if known.
    """
    faces = stiv.find_intersections(q, assembly.surface, threads=threads) if intersecting is None else intersecting
    if not has_loose_elements(assembly.surface):
        return assembly.face_pairs(faces)[0]
    edges, vertices = stiv.find_loose_intersections(q, assembly.surface, threads=threads)
    loose = [(assembly.loose_edge(a), assembly.face(b)) for a, b in edges.tolist()]
    loose += [(assembly.vertex(a), assembly.face(b)) for a, b in vertices.tolist()]
    return assembly.face_pairs(faces)[0].joined(FacePair(*both) for both in loose)


def has_loose_elements(surface: stiv.Surface) -> bool:
    """Has a surface edges or vertices without triangles?"""
    used = np.zeros(surface.vertex_count, bool)
    used[surface.triangles] = True
    return len(surface.loose_edges) > 0 or not bool(used.all())


class EventElements:
    """Finds an element on either side of each event: a face if there is one, otherwise a loose edge or a vertex."""

    def __init__(self, assembly: Assembly, events: stiv.Events) -> None:
        """Index the part of the assembly's surface that the events touch."""
        self._assembly = assembly
        self._events = events
        triangles = assembly.surface.triangles
        touched = np.zeros(assembly.surface.vertex_count, bool)
        touched[events.vertices.ravel()] = True
        self._triangles: dict[tuple[int, ...], int] = {}  # by one, two or three sorted vertices
        for index in np.flatnonzero(touched[triangles].any(axis=1)).tolist():
            a, b, c = sorted(triangles[index].tolist())
            for corners in ((a,), (b,), (c,), (a, b), (b, c), (a, c), (a, b, c)):
                self._triangles.setdefault(corners, index)
        self._loose = {tuple(sorted(edge)): index for index, edge in enumerate(assembly.surface.loose_edges.tolist())}

    def of(self, number: int) -> tuple[Element, Element]:
        """The two elements of an event."""
        vertices = self._events.vertices[number]
        split = 1 if self._events.kind[number] == 0 else 2  # a vertex and a face, or two edges
        return self._element(vertices[:split]), self._element(vertices[split:])

    def _element(self, vertices: Indices) -> Element:
        corners = tuple(sorted(vertices.tolist()))
        triangle = self._triangles.get(corners)
        if triangle is not None:
            return self._assembly.face(triangle)
        if corners in self._loose:
            return self._assembly.loose_edge(self._loose[corners])
        return self._assembly.vertex(corners[0])
