# SPDX-License-Identifier: GPL-3.0-or-later
"""An assembly with those elements of its obstacles that are near its moving surface, for tests of one state."""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import stiv
from stiv.blender.scene.arrays import Floats, Indices, extents
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.evaluated_scene import VisibleMesh

MARGIN = 0.25  # of the box around the moving surface on each side, in its diagonals
LEAST_MARGIN = 0.01  # that a state must keep from the sides of the box, in the same measure


@dataclass(frozen=True, eq=False)
class NearAssembly:
    """The surface of an assembly, then the elements of its obstacles that touch a box.

    Attributes:
        whole: the assembly with all its obstacles.
        assembly: without obstacles. Its first meshes, vertices, triangles and bodies are those of the whole.
        obstacles: number of the obstacle of each further mesh.
        low: corner of the box, (3,).
        high: the opposite corner.
    """

    whole: Assembly
    assembly: Assembly
    obstacles: tuple[int, ...]
    low: Floats
    high: Floats

    def extended(self, surface: Floats) -> Floats:
        """Positions of all vertices of `assembly`, (M, 3), from those of the whole, (N, 3)."""
        return np.concatenate([surface, self.assembly.positions[len(surface) :]]) if self.obstacles else surface

    def covers(self, surface: Floats) -> bool:
        """Can no element outside of the box intersect the surface, (N, 3)?"""
        if not self.whole.obstacles:
            return True
        low, high = _bounds(self.whole, surface, LEAST_MARGIN)
        return bool((low >= self.low).all() and (high <= self.high).all())

    def vertices_of(self, numbers: Indices) -> Indices:
        """Vertices of `assembly` from those of a session beside all obstacles; -1 for those outside of the box."""
        own = len(self.whole.positions)
        found = np.where(numbers < own, numbers, -1)
        firsts = own + np.cumsum([0, *(each.vertex_count for each in self.whole.obstacles)])
        for mesh, obstacle in enumerate(self.obstacles, len(self.whole.meshes)):
            cropped = self.assembly.meshes[mesh].cropped
            assert cropped is not None
            within = numbers - firsts[obstacle]
            if len(cropped.vertices):
                places = np.minimum(np.searchsorted(cropped.vertices, within), len(cropped.vertices) - 1)
                found = np.where(cropped.vertices[places] == within, places + self.assembly.starts[mesh], found)
        return found.astype(np.int32)


_latest: weakref.ref[NearAssembly] | None = None  # those who test states keep it alive


def near_assembly(assembly: Assembly, surface: Floats) -> NearAssembly:
    """The assembly near its moving vertices on a surface, (N, 3); the latest one as long as it covers them."""
    global _latest
    latest = None if _latest is None else _latest()
    if latest is not None and latest.whole is assembly and latest.covers(surface):
        return latest
    found = _make(assembly, surface)
    _latest = weakref.ref(found)
    return found


def _make(assembly: Assembly, surface: Floats) -> NearAssembly:
    if not assembly.obstacles:
        return NearAssembly(assembly, assembly, (), np.full(3, -np.inf), np.full(3, np.inf))
    low, high = _bounds(assembly, surface, MARGIN)
    found = [each.obstacle.triangles_near(low, high) for each in assembly.obstacles]
    numbers = tuple(number for number, rows in enumerate(found) if len(rows))
    crops = [assembly.obstacles[number].cropped(found[number]) for number in numbers]
    return NearAssembly(assembly, _extended(assembly, crops), numbers, low, high)


def _extended(assembly: Assembly, crops: Sequence[VisibleMesh]) -> Assembly:
    old, bodies, own = assembly.surface, [*assembly.surface.bodies], dict[str, int]()
    triangles, edges, body, starts = [old.triangles], [old.loose_edges], [old.vertex_body], [*assembly.starts.tolist()]
    for mesh in crops:
        triangles.append(mesh.triangles + np.int32(starts[-1]))
        edges.append(mesh.loose_edges + np.int32(starts[-1]))
        if mesh.owner.name not in own:  # instances of an owner are one body
            own[mesh.owner.name] = len(bodies)
            bodies.append(stiv.Body(mesh.owner.name, "fixed"))
        body.append(np.full(len(mesh.local), own[mesh.owner.name], np.int32))
        starts.append(starts[-1] + len(mesh.local))
    ignored = [(int(a), int(b)) for a, b in old.ignored]
    surface = stiv.Surface(
        np.concatenate(triangles), starts[-1], np.concatenate(edges), np.concatenate(body), bodies, ignored,
        old.flip_faces,
    )  # fmt: skip
    positions = np.concatenate([assembly.positions, *(mesh.world() for mesh in crops)])
    meshes, seams = (*assembly.meshes, *crops), (*assembly.seams, *(None for _ in crops))
    return Assembly(meshes, np.array(starts, np.int32), surface, positions, seams)


def _bounds(assembly: Assembly, surface: Floats, margin: float) -> tuple[Floats, Floats]:
    """The box around the moving vertices, with a margin in its diagonals; empty if nothing moves."""
    moving = np.array([body.mobility != "fixed" for body in assembly.surface.bodies], np.bool_)
    points = surface[moving[assembly.surface.vertex_body]]
    if len(points) == 0:
        return np.full(3, np.inf), np.full(3, -np.inf)
    low, high = extents(points)
    around = margin * float(np.linalg.norm(high - low))
    return low - around, high + around
