# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads all visible meshes and strands as Blender evaluates them, in world space."""

from collections import Counter
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from stiv import InputError
from stiv.blender.scene.arrays import Floats, Indices, Singles, as_matrix, extents, transform_points
from stiv.blender.scene.deferred_meshes import EqualMeshes
from stiv.blender.scene.evaluations import (
    EVALUATIONS,
    RENDER,
    SHOWN,
    SURFACE_TYPES,
    VIEWPORT,
    is_visible,
    rendered_objects,
)
from stiv.blender.scene.mesh_reading import (
    evaluated_mesh,
    read_edges,
    read_loose_numbers,
    read_positions,
    read_triangles,
    view_positions,
)
from stiv.blender.scene.open_evaluations import OpenEvaluations, open_evaluations
from stiv.blender.scene.references import ObjectReference
from stiv.blender.scene.strand_reading import (
    STRAND_TYPES,
    check_finite,
    hair_systems,
    helper_curves,
    read_particle_hair,
    read_strands,
    surface_of,
    why_no_particle_hair,
    why_no_strands,
)
from stiv.blender.scene.strands import Strands, cover_strands


@dataclass(frozen=True)
class CroppedMesh:
    """Some faces, loose edges and loose vertices of a mesh.

    Attributes:
        vertices: ascending vertex numbers, (n,).
        local: positions, (n, 3).
        triangles: Blender's triangulation, indices into `vertices`, (f, 3).
        faces: face of each triangle, (f,).
        loose_edges: indices into `vertices`, (l, 2).
        loose_numbers: edge number of each loose edge, (l,).
        size: number of vertices of the whole mesh.
    """

    vertices: Indices
    local: Singles
    triangles: Indices
    faces: Indices
    loose_edges: Indices
    loose_numbers: Indices
    size: int


@dataclass(frozen=True)
class VisibleMesh:
    """One evaluated mesh and its placement in the world.

    Attributes:
        owner: the object that shows it; for an instance the instancer.
        source: name of the object whose data is shown; the owner's name unless it is an instance.
        local: positions in its own frame as stored, (n, 3): single precision, for strands double.
        matrix: frame to world, (4, 4).
        triangles: Blender's triangulation, (f, 3).
        faces: face of each triangle, (f,).
        loose_edges: edges without a face, (l, 2).
        loose_numbers: edge number of each loose edge, (l,).
        cropped: the elements of Blender's mesh that were read; None for all.
        read_from: the evaluation from which it was read.
        shown_in: the evaluations that show exactly this mesh.
        also_in: those of them that Blender evaluates apart.
        static: number among the meshes that the owner shows, if it is a part of an obstacle; -1 otherwise.
        strands: strand of each vertex, (n,), of curves and hair; None for meshes.
        rooted_in: names of the objects that carry the strands, and are not tested against them.
        part: number of the part, if a mesh is divided into several that follow each other.
    """

    owner: ObjectReference
    source: str
    local: NDArray[Any]
    matrix: Floats
    triangles: Indices
    faces: Indices
    loose_edges: Indices
    loose_numbers: Indices
    cropped: CroppedMesh | None = None
    read_from: str = SHOWN
    shown_in: frozenset[str] = frozenset(EVALUATIONS)
    strands: Indices | None = None
    rooted_in: frozenset[str] = frozenset()
    part: int = 0
    also_in: frozenset[str] = frozenset()
    static: int = -1

    @property
    def is_static(self) -> bool:
        """Is it a part of an obstacle beside the surface?"""
        return self.static >= 0

    @property
    def is_instance(self) -> bool:
        """Is it shown by another object?"""
        return self.source != self.owner.name

    def world(self) -> Floats:
        """World positions, (n, 3), read-only."""
        return self._world

    @cached_property
    def _world(self) -> Floats:
        positions = transform_points(self.matrix, self.local)
        positions.setflags(write=False)
        return positions

    def vertex_number(self, vertex: int) -> int:
        """Number of a vertex in Blender's mesh."""
        return vertex if self.cropped is None else int(self.cropped.vertices[vertex])

    def own_triangles(self, triangles: Indices, faces: Indices) -> tuple[Indices, Indices]:
        """Those of all triangles of Blender's mesh that belong to this one, and their faces."""
        if self.cropped is None:
            return triangles, faces
        place = np.full(self.size, -1, np.int32)
        place[self.cropped.vertices] = np.arange(len(self.local), dtype=np.int32)
        rows = np.isin(faces, self.faces)
        return place[triangles[rows]], faces[rows]

    @property
    def size(self) -> int:
        """Number of vertices of Blender's mesh."""
        return len(self.local) if self.cropped is None else self.cropped.size


@dataclass(frozen=True)
class EvaluatedScene:
    """All visible meshes, and the number of hidden or excluded objects with a surface."""

    meshes: tuple[VisibleMesh, ...]
    hidden: int


@dataclass(frozen=True)
class EvaluatedPositions:
    """Positions of one visible mesh, read back after writing."""

    owner: ObjectReference
    local: Singles
    matrix: Floats

    def world(self) -> Floats:
        """World positions, (n, 3)."""
        return transform_points(self.matrix, self.local)

    def limited_to(self, vertices: Indices) -> "EvaluatedPositions":
        """The positions of some vertices, (k,)."""
        return EvaluatedPositions(self.owner, self.local[vertices], self.matrix)


def read_scene(
    context: bpy.types.Context,
    accept: Callable[[str], bool] = lambda name: True,
    evaluations: Collection[str] = (SHOWN,),
    strands: bool = False,
    static: Collection[str] = (),
) -> EvaluatedScene:
    """Read every mesh whose owner's name is accepted; those of `static` owners are left out, but not their hair.

    evaluations: those to read. A mesh that several of them share is returned once. Curves, text, surfaces, metaballs
    and instances are read as meshes. Local view applies if the context has a 3D view, except to the render. strands:
    also read curves without surface, hair curves and particle hair, after all meshes. Raises InputError naming object
    and vertex if a coordinate is not finite.
    """
    shown: dict[int, bool] = {}

    def is_shown(owner: bpy.types.Object) -> bool:
        if owner.session_uid not in shown:
            shown[owner.session_uid] = is_visible(context, owner)
        return shown[owner.session_uid]

    meshes: list[VisibleMesh] = []
    found: list[VisibleMesh] = []
    with open_evaluations(context, evaluations) as opened:
        for read_from in opened.read_from:

            def is_wanted(owner: bpy.types.Object, read_from: str = read_from) -> bool:
                exists = opened.shown_in(read_from, owner.session_uid)
                return bool(exists) and accept(owner.name) and (read_from == RENDER or is_shown(owner))

            def is_surface(owner: bpy.types.Object, is_wanted: Any = is_wanted) -> bool:
                return owner.name not in static and bool(is_wanted(owner))

            equal = EqualMeshes(opened.depsgraph(read_from))
            for instance, owner, source in opened.instances(read_from, is_surface):
                shown_in = opened.shown_in(read_from, owner.session_uid)
                evaluated = equal.representative(instance.object)
                meshes.append(
                    _read_mesh(evaluated, as_matrix(instance.matrix_world), owner, source, read_from, shown_in)
                )
            if strands:
                found += _read_strands(context, opened, read_from, is_wanted)
        if strands:
            found += _read_particle_hair(context, opened, lambda owner: accept(owner.name) and is_shown(owner))
    return EvaluatedScene((*meshes, *found), _count_hidden(context, evaluations))


def read_positions_of(
    owners: frozenset[int], opened: OpenEvaluations, read_from: str = SHOWN
) -> list[EvaluatedPositions]:
    """Read only the positions of the given owners (session numbers), in the order of `read_scene`; much faster."""
    placed = []
    for instance, owner, _ in opened.instances(read_from, lambda ob: ob.session_uid in owners):
        with evaluated_mesh(instance.object) as mesh:
            matrix = as_matrix(instance.matrix_world)
            placed.append(EvaluatedPositions(ObjectReference.of(owner), read_positions(mesh), matrix))
    return placed


def view_positions_of(wanted: Collection[tuple[int, int]], opened: OpenEvaluations) -> list[EvaluatedPositions]:
    """View positions as shown now, in the order of `read_scene`, valid until Blender evaluates again.

    wanted: session number of the owner, and number of the mesh among those that it shows.
    """
    owners, counts = {owner for owner, _ in wanted}, Counter[int]()
    placed = []
    for instance, owner, _ in opened.instances(SHOWN, lambda ob: ob.session_uid in owners):
        number = owner.session_uid
        if (number, counts[number]) in wanted:
            with evaluated_mesh(instance.object) as mesh:
                matrix = as_matrix(instance.matrix_world)
                placed.append(EvaluatedPositions(ObjectReference.of(owner), view_positions(mesh), matrix))
        counts[number] += 1
    return placed


def _read_mesh(
    evaluated: bpy.types.Object,
    matrix: Floats,
    shown_by: bpy.types.Object,
    data_of: bpy.types.Object,
    read_from: str,
    shown_in: frozenset[str],
) -> VisibleMesh:
    with evaluated_mesh(evaluated) as mesh:
        triangles, faces = read_triangles(mesh)
        loose = read_loose_numbers(mesh)
        edges = read_edges(mesh)[loose] if len(loose) else np.empty((0, 2), np.int32)
        local = read_positions(mesh)
    check_finite_positions(shown_by.name, matrix, local)
    owner = ObjectReference.of(shown_by)
    return VisibleMesh(owner, data_of.name, local, matrix, triangles, faces, edges, loose, None, read_from, shown_in)


def _read_strands(
    context: bpy.types.Context, opened: OpenEvaluations, read_from: str, is_wanted: Callable[[bpy.types.Object], bool]
) -> Iterator[VisibleMesh]:
    """Read curves without surface and hair curves of an evaluation."""
    helpers = helper_curves(context)
    for instance, owner, source in opened.instances(read_from, is_wanted, STRAND_TYPES):
        if not why_no_strands(instance.object, source, helpers):
            shown_in = opened.shown_in(read_from, owner.session_uid)
            yield from _strand_mesh(read_strands(instance), owner, source, read_from, shown_in)


def _read_particle_hair(
    context: bpy.types.Context, opened: OpenEvaluations, is_wanted: Callable[[bpy.types.Object], bool]
) -> Iterator[VisibleMesh]:
    graph = context.evaluated_depsgraph_get()
    for ob in context.view_layer.objects:
        shown_in = opened.hair_shown_in(ob.session_uid)
        if shown_in and hair_systems(ob) and is_wanted(ob):
            evaluated = ob.evaluated_get(graph)
            if not why_no_particle_hair(evaluated):
                yield from _strand_mesh(read_particle_hair(evaluated), ob, ob, SHOWN, shown_in)


def _strand_mesh(
    strands: Strands, owner: bpy.types.Object, source: bpy.types.Object, read_from: str, shown_in: frozenset[str]
) -> Iterator[VisibleMesh]:
    """The surface of strands as a mesh in world space; nothing if there are no segments."""
    check_finite(strands, owner.name)
    surface = cover_strands(strands)
    if len(surface.positions):
        faces = surface.numbers[surface.triangles[:, 0]]
        numbers = surface.numbers[surface.edges[:, 0]]
        yield VisibleMesh(
            ObjectReference.of(owner), source.name, surface.positions, np.eye(4), surface.triangles, faces,
            surface.edges, numbers, None, read_from, shown_in, surface.numbers, _find_roots(owner),
        )  # fmt: skip


def _find_roots(owner: bpy.types.Object) -> frozenset[str]:
    """Names of the object, its parents, the surface of its hair curves, and the children of a curve."""
    found, waiting = set(), [owner]
    while waiting:
        ob = waiting.pop()
        found.add(ob.name)
        above = (ob.parent, surface_of(ob))
        waiting += [each for each in above if each is not None and each.name not in found]
    if owner.type == "CURVE":
        found |= {child.name for child in owner.children_recursive}
    return frozenset(found)


def check_finite_positions(name: str, matrix: Floats, local: Singles) -> None:
    """Raise InputError if an object's placement, (4, 4), or one of its positions, (n, 3), is not finite."""
    if not np.isfinite(matrix).all():
        raise InputError(f"{name}: its transform is not finite; clear its location and scale")
    finite = np.isfinite(local)
    if not finite.all():
        vertex = int(np.argmin(finite.all(axis=1)))
        raise InputError(f"{name}: vertex {vertex} has a coordinate that is not finite; delete it")


def _count_hidden(context: bpy.types.Context, evaluations: Collection[str]) -> int:
    """Number of objects with a surface that none of the evaluations shows."""
    shown: set[int] = set()
    if SHOWN in evaluations or VIEWPORT in evaluations:
        shown |= {ob.session_uid for ob in context.view_layer.objects if is_visible(context, ob)}
    if RENDER in evaluations:
        shown |= rendered_objects(context.view_layer)
    return sum(ob.type in SURFACE_TYPES and ob.session_uid not in shown for ob in context.scene.objects)


TOLERANCE = 1e-5  # of an object's size: rounding to single precision, and in Blender's modifiers


def evaluation_tolerance(points: Floats) -> float:
    """Maximum difference between two evaluations of the same points, (n, 3), in world units."""
    if len(points) == 0:
        return 0.0
    low, high = extents(points)
    return TOLERANCE * float((high - low).max()) + 1e-6 * float(max(-low.min(), high.max()))
