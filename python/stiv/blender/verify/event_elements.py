# SPDX-License-Identifier: GPL-3.0-or-later
"""The faces, loose edges and vertices of objects that the events of a step belong to."""

from __future__ import annotations

import numpy as np

import stiv
from stiv.blender.scene.arrays import Indices
from stiv.blender.scene.assembly import Assembly, Element


class EventElements:
    """Finds for each event a face on either side; a loose edge or a vertex where there is no face."""

    def __init__(self, assembly: Assembly, events: stiv.Events) -> None:
        """Index what the events touch of the assembly's surface."""
        self._assembly = assembly
        self._events = events
        triangles = assembly.surface.triangles
        touched = np.zeros(assembly.surface.vertex_count, bool)
        touched[events.vertices.ravel()] = True
        self._triangles: dict[tuple[int, ...], int] = {}  # by one, two or three of its vertices, sorted
        for index in np.flatnonzero(touched[triangles].any(axis=1)).tolist():
            a, b, c = sorted(triangles[index].tolist())
            for corners in ((a,), (b,), (c,), (a, b), (b, c), (a, c), (a, b, c)):
                self._triangles.setdefault(corners, index)
        self._loose = {tuple(sorted(edge)): index for index, edge in enumerate(assembly.surface.loose_edges.tolist())}

    def of(self, number: int) -> tuple[Element, Element]:
        """The two sides of an event."""
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
