# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that is visible, as Blender evaluates it, in world space."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.arrays import Floats, Indices, Singles, as_matrix, transform_points
from stiv.blender.mesh_reading import evaluated_mesh, read_edges, read_loose_numbers, read_positions, read_triangles
from stiv.blender.near_faces import NearFaces, read_near_faces
from stiv.blender.references import ObjectReference

SURFACE_TYPES = frozenset({"MESH", "CURVE", "SURFACE", "FONT", "META", "CURVES", "POINTCLOUD"})


@dataclass(frozen=True)
class VisibleMesh:
    """One evaluated mesh, where it stands in the world.

    Attributes:
        owner: the object that shows it: for an instance, the object that makes the instance.
        source: name of the object whose data is shown; the owner's own name for what is not an instance.
        local: positions in its own frame as stored, (n, 3).
        matrix: frame to world, (4, 4).
        triangles: Blender's triangulation, (f, 3).
        faces: the face each triangle belongs to, (f,).
        loose_edges: edges of no face, (l, 2).
        loose_numbers: their numbers among all edges, (l,).
        near: which part of Blender's mesh this is; None: all of it.
    """

    owner: ObjectReference
    source: str
    local: Singles
    matrix: Floats
    triangles: Indices
    faces: Indices
    loose_edges: Indices
    loose_numbers: Indices
    near: NearFaces | None = None

    @property
    def is_instance(self) -> bool:
        """Shown through another object."""
        return self.source != self.owner.name

    def world(self) -> Floats:
        """World positions, (n, 3)."""
        return transform_points(self.matrix, self.local)

    def vertex_number(self, vertex: int) -> int:
        """Number of a vertex in Blender's mesh."""
        return vertex if self.near is None else int(self.near.vertices[vertex])

    @property
    def size(self) -> int:
        """Number of vertices of Blender's mesh."""
        return len(self.local) if self.near is None else self.near.size


@dataclass(frozen=True)
class EvaluatedScene:
    """All visible meshes, and how many objects with a surface are hidden or excluded."""

    meshes: tuple[VisibleMesh, ...]
    hidden: int


@dataclass(frozen=True)
class Placed:
    """Positions alone of one visible mesh, for reading back."""

    owner: ObjectReference
    local: Singles
    matrix: Floats

    def world(self) -> Floats:
        """World positions, (n, 3)."""
        return transform_points(self.matrix, self.local)

    def limited_to(self, vertices: Indices) -> "Placed":
        """Some of the vertices, (k,)."""
        return Placed(self.owner, self.local[vertices], self.matrix)


def read_scene(
    context: bpy.types.Context,
    accept: Callable[[str], bool] = lambda name: True,
    box_of: Callable[[str], tuple[Floats, Floats] | None] = lambda name: None,
) -> EvaluatedScene:
    """Read every visible mesh whose owner's name is accepted; with a box of the world, (3,) and (3,), what touches it.

    Curves, text, surfaces, metaballs and instances come as the meshes they show. Local view is respected where the
    context has a 3D view. Raises InputError naming object and vertex when a coordinate is not finite.
    """
    shown: dict[int, bool] = {}

    def is_shown(owner: bpy.types.Object) -> bool:
        if owner.session_uid not in shown:
            shown[owner.session_uid] = accept(owner.name) and is_visible(context, owner)
        return shown[owner.session_uid]

    meshes = [_read_mesh(instance, owner, box_of(owner.name)) for instance, owner in _mesh_instances(context, is_shown)]
    return EvaluatedScene(tuple(meshes), _hidden_count(context))


def read_placed(context: bpy.types.Context, owners: frozenset[int]) -> list[Placed]:
    """Positions of what these owners (session numbers) show, in the order of `read_scene`; much cheaper than all."""
    placed = []
    for instance, owner in _mesh_instances(context, lambda ob: ob.session_uid in owners):
        with evaluated_mesh(instance.object) as mesh:
            placed.append(Placed(owner, read_positions(mesh), as_matrix(instance.matrix_world)))
    return placed


def is_visible(context: bpy.types.Context, ob: bpy.types.Object) -> bool:
    """Is the object visible in the context's view layer and, where there is one, local view?"""
    return bool(ob.visible_get(view_layer=context.view_layer, viewport=_local_view(context)))


def _local_view(context: bpy.types.Context) -> bpy.types.SpaceView3D | None:
    space = context.space_data
    return space if isinstance(space, bpy.types.SpaceView3D) and space.local_view is not None else None


def _mesh_instances(
    context: bpy.types.Context, is_shown: Callable[[bpy.types.Object], bool]
) -> Iterator[tuple[bpy.types.DepsgraphObjectInstance, ObjectReference]]:
    for instance in context.evaluated_depsgraph_get().object_instances:
        if instance.object.type != "MESH" or not (instance.show_self or instance.is_instance):
            continue
        owner = instance.parent.original if instance.is_instance else instance.object.original
        if is_shown(owner):
            yield instance, ObjectReference.of(owner)


def _read_mesh(
    instance: bpy.types.DepsgraphObjectInstance, owner: ObjectReference, box: tuple[Floats, Floats] | None
) -> VisibleMesh:
    source = instance.instance_object.original.name if instance.is_instance else owner.name
    matrix = as_matrix(instance.matrix_world)
    with evaluated_mesh(instance.object) as mesh:
        if box is not None:
            near = read_near_faces(mesh, matrix, *box)
            found = VisibleMesh(
                owner, source, near.local, matrix, near.triangles, near.faces, near.loose_edges, near.loose_numbers,
                near,
            )  # fmt: skip
        else:
            triangles, faces = read_triangles(mesh)
            loose = read_loose_numbers(mesh)
            edges = read_edges(mesh)[loose] if len(loose) else np.empty((0, 2), np.int32)
            found = VisibleMesh(owner, source, read_positions(mesh), matrix, triangles, faces, edges, loose)
    _check_finite(found)
    return found


def _check_finite(mesh: VisibleMesh) -> None:
    if not np.isfinite(mesh.matrix).all():
        raise InputError(f'object "{mesh.owner.name}": its placement is not finite; clear its location and scale')
    finite = np.isfinite(mesh.local).all(axis=1)
    if not finite.all():
        vertex = mesh.vertex_number(int(np.argmin(finite)))
        raise InputError(f'object "{mesh.owner.name}", vertex {vertex}: coordinate is not finite')


def _hidden_count(context: bpy.types.Context) -> int:
    shown = {ob.session_uid for ob in context.view_layer.objects if is_visible(context, ob)}
    return sum(ob.type in SURFACE_TYPES and ob.session_uid not in shown for ob in context.scene.objects)
