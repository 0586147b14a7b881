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
    """Tests what Blender evaluates against accepted surfaces; keeps its trees."""

    def __init__(self, assembly: Assembly, threads: int = 0) -> None:
        """For the meshes of an assembly; threads 0 for all."""
        self._assembly = assembly
        self._threads = threads
        self._steps = stiv.StepCheck(assembly.surface, threads)

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
        if not self._steps.is_free(accepted, shown):
            return self._failure(self._assembly.surface, shown)
        present = _present_surface(context, self._assembly)
        if present is not self._assembly.surface and not self._is_free(present, shown):
            return self._failure(present, shown)
        return WriteReport(True)

    def _is_free(self, surface: stiv.Surface, shown: Floats) -> bool:
        return len(stiv.find_intersections(shown, surface, threads=self._threads)) == 0

    def _failure(self, surface: stiv.Surface, shown: Floats) -> WriteReport:
        pairs = named_pairs(self._assembly, surface, shown, self._threads)
        if not pairs:
            return WriteReport(False, (), "what Blender shows comes too near; use a larger separation")
        return WriteReport(False, pairs, _told(pairs))


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


def named_pairs(assembly: Assembly, surface: stiv.Surface, q: Floats, threads: int = 0) -> tuple[FacePair, ...]:
    """All pairs that meet at positions `q`, (N, 3), loose edges and vertices included.

    surface: the assembly's, or one that differs from it in the way faces are cut into triangles.
    """
    faces = stiv.find_intersections(q, surface, threads=threads)
    edges, vertices = stiv.find_loose_intersections(q, surface, threads=threads)
    return (
        *(FacePair(assembly.face(int(a)), assembly.face(int(b))) for a, b in faces),
        *(FacePair(assembly.loose_edge(int(a)), assembly.face(int(b))) for a, b in edges),
        *(FacePair(assembly.vertex(int(a)), assembly.face(int(b))) for a, b in vertices),
    )


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
