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


def verify(context: bpy.types.Context, assembly: Assembly, accepted: Floats) -> WriteReport:
    """Test what Blender evaluates against the accepted surface, (N, 3).

    It must be where the accepted surface is, to within single precision; the way there must be free; and it must be
    free of intersections, in the triangulation of the start and in Blender's present one, which follows the shape.
    Raises SceneChangedError when other meshes are visible than at the start.
    """
    shown = read_shown(context, assembly)
    message = _elsewhere(assembly, accepted, shown)
    if message:
        return WriteReport(False, (), message)
    if not stiv.is_step_free(assembly.surface, accepted, shown):
        return _failure(assembly, assembly.surface, shown)
    present = _present_surface(context, assembly)
    if present is not assembly.surface and len(stiv.find_intersections(shown, present)):
        return _failure(assembly, present, shown)
    return WriteReport(True)


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


def _failure(assembly: Assembly, surface: stiv.Surface, shown: Floats) -> WriteReport:
    pairs = tuple(
        FacePair(assembly.face(int(a)), assembly.face(int(b))) for a, b in stiv.find_intersections(shown, surface)
    )
    if not pairs:
        return WriteReport(False, (), "what Blender shows comes too near to be told apart; use a larger separation")
    first, second = pairs[0].first, pairs[0].second
    return WriteReport(
        False, pairs,
        f"{len(pairs)} pairs of triangles meet in what Blender shows, the first in "
        f'object "{first.object}", face {first.number} and object "{second.object}", face {second.number}',
    )  # fmt: skip


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
