# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own evaluation after writing, read back and tested."""

from dataclasses import dataclass

import bpy
import numpy as np

import stiv
from stiv.blender.arrays import Floats
from stiv.blender.assembly import Assembly, Element, shifted_triangles
from stiv.blender.errors import SceneChangedError
from stiv.blender.evaluated_scene import Placed, read_placed
from stiv.blender.mesh_reading import evaluated_mesh, read_triangles
from stiv.blender.participants import tolerance


@dataclass(frozen=True)
class FacePair:
    """Two elements that meet; the second is always a face."""

    first: Element
    second: Element


@dataclass(frozen=True)
class WriteReport:
    """Did what Blender shows pass? If not, the last state that did was put back, and `message` says why."""

    passed: bool
    intersections: tuple[FacePair, ...] = ()
    message: str = ""


class Verifier:
    """Tests what Blender evaluates against accepted surfaces; keeps the trees of the path check."""

    def __init__(self, assembly: Assembly, threads: int = 0) -> None:
        """For the meshes of an assembly; threads 0 for all."""
        self._assembly = assembly
        self._threads = threads
        self._detector = stiv.Detector(assembly.surface, threads=threads)
        self._has_loose = _has_loose(assembly)

    def verify(self, context: bpy.types.Context, accepted: Floats) -> WriteReport:
        """Test what Blender evaluates now against the accepted surface, (N, 3), which is free of intersections.

        It must be where the accepted surface is, to within single precision; the way there must be free; and it must
        be free of intersections, in the triangulation of the start and in Blender's present one, which follows the
        shape. Raises SceneChangedError when other meshes are visible than at the start.
        """
        shown = read_shown(context, self._assembly)
        message = _elsewhere(self._assembly, accepted, shown)
        if message:
            return WriteReport(False, (), message)
        surfaces = {self._assembly.surface, _present_surface(context, self._assembly)}
        pairs = next((found for surface in surfaces if (found := self._pairs(surface, shown))), ())
        if pairs:
            return WriteReport(False, pairs, _told(pairs))
        if self._detector.earliest_time(accepted, shown) <= 1:
            return WriteReport(False, (), "what Blender shows comes too near; use a larger separation")
        return WriteReport(True)

    def _pairs(self, surface: stiv.Surface, shown: Floats) -> tuple[FacePair, ...]:
        """Found in a surface over the assembly's vertices whose triangles may be cut in another way."""
        return named_pairs(self._assembly, surface, shown, self._threads, self._has_loose)


def read_shown(context: bpy.types.Context, assembly: Assembly) -> Floats:
    """World positions of the assembly's meshes as Blender evaluates them now, (N, 3)."""
    owners = frozenset(mesh.owner.session_uid for mesh in assembly.meshes)
    placed = read_placed(context, owners)
    if [_shape(each) for each in placed] != [(len(mesh.local), mesh.owner.session_uid) for mesh in assembly.meshes]:
        raise SceneChangedError("objects were shown, hidden or changed in size during the edit")
    return np.concatenate([np.empty((0, 3)), *(each.world() for each in placed)])


def _shape(placed: Placed) -> tuple[int, int]:
    return len(placed.local), placed.owner.session_uid


def _elsewhere(assembly: Assembly, accepted: Floats, shown: Floats) -> str:
    for number, mesh in enumerate(assembly.meshes):
        part = slice(assembly.starts[number], assembly.starts[number + 1])
        difference = float(np.abs(shown[part] - accepted[part]).max(initial=0.0))
        if not difference <= tolerance(accepted[part]):
            return f'object "{mesh.owner.name}": Blender shows it {difference:.3g} away from where it was to be'
    return ""


def named_pairs(
    assembly: Assembly, surface: stiv.Surface, q: Floats, threads: int = 0, loose: bool = True
) -> tuple[FacePair, ...]:
    """All pairs that meet, (N, 3) positions `q`, in a surface that differs from the assembly's in its cuts at most.

    loose: look at loose edges and vertices too.
    """
    found = [
        FacePair(assembly.face(int(a)), assembly.face(int(b)))
        for a, b in stiv.find_intersections(q, surface, threads=threads)
    ]
    if loose:
        edges, vertices = stiv.find_loose_intersections(q, surface, threads=threads)
        found += [FacePair(assembly.loose_edge(int(a)), assembly.face(int(b))) for a, b in edges]
        found += [FacePair(assembly.vertex(int(a)), assembly.face(int(b))) for a, b in vertices]
    return tuple(found)


def _has_loose(assembly: Assembly) -> bool:
    in_faces = np.zeros(assembly.surface.vertex_count, np.bool_)
    in_faces[assembly.surface.triangles.ravel()] = True
    return len(assembly.surface.loose_edges) > 0 or not in_faces.all()


def _told(pairs: tuple[FacePair, ...]) -> str:
    first, second = pairs[0].first, pairs[0].second
    return (
        f"{len(pairs)} pairs meet in what Blender shows, the first are "
        f'object "{first.object}", {first.kind} {first.number} and '
        f'object "{second.object}", {second.kind} {second.number}'
    )


def _present_surface(context: bpy.types.Context, assembly: Assembly) -> stiv.Surface:
    """The surface with Blender's present triangles; the same one where nothing has changed.

    Blender cuts concave quads and polygons as their shape wants it, so moving vertices can change the cuts. Only
    deformable bodies change their shape.
    """
    surface = assembly.surface
    mobility = [surface.bodies[surface.vertex_body[start]].mobility if start < surface.vertex_count else "fixed"
                for start in assembly.starts[:-1]]  # fmt: skip
    graph = context.evaluated_depsgraph_get()
    triangles, changed = [], False
    for mesh, kind in zip(assembly.meshes, mobility, strict=True):
        triangles.append(mesh.triangles)
        if kind == "deformable":
            with evaluated_mesh(mesh.owner.find().evaluated_get(graph)) as evaluated:
                present, _ = read_triangles(evaluated)
            if not np.array_equal(present, mesh.triangles):
                changed, triangles[-1] = True, present
    if not changed:
        return surface
    return stiv.Surface(
        shifted_triangles(triangles, assembly.starts), surface.vertex_count, surface.loose_edges,
        surface.vertex_body, surface.bodies, [(int(a), int(b)) for a, b in surface.ignored],
    )  # fmt: skip
