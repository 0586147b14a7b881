# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the targets of snapping: visible objects and instances, in the state at the start of a drag."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import bmesh
import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from stiv.blender.scene.arrays import Floats, Indices, as_matrix, read_collection
from stiv.blender.scene.mesh_reading import read_corners, read_edges, read_positions

POINTS = frozenset({"EMPTY", "LIGHT", "CAMERA", "SPEAKER", "LIGHT_PROBE"})  # objects whose origin is a vertex
RayHit = tuple[Floats, Floats, int]  # position, normal, face
NO_EDGES = np.empty((0, 2), np.int32)


@dataclass(frozen=True)
class SnapMesh:
    """Elements of a mesh, in the space of its object.

    Attributes:
        vertices: (n, 3) positions.
        edges: (e, 2) vertices of each edge.
        corner_vertices, corner_edges: (c,) vertex and edge of each corner of a face.
        starts: (f + 1,) first corner of each face, and the number of corners.

    """

    vertices: Floats
    edges: Indices
    corner_vertices: Indices = field(default_factory=lambda: np.empty(0, np.int32))
    corner_edges: Indices = field(default_factory=lambda: np.empty(0, np.int32))
    starts: Indices = field(default_factory=lambda: np.zeros(1, np.int32))

    @cached_property
    def loose(self) -> Indices:
        """Vertices without an edge, (l,)."""
        used = np.zeros(len(self.vertices), bool)
        used[self.edges.ravel()] = True
        return np.flatnonzero(~used).astype(np.int32)

    def vertex_normal(self, vertex: int) -> Floats:
        """Unit normal of a vertex, (3,), as Blender's: of its faces by their angles; without faces, its direction."""
        normal = np.zeros(3)
        for corner in np.flatnonzero(self.corner_vertices == vertex):
            face = int(np.searchsorted(self.starts, corner, side="right")) - 1
            corners = self.vertices[self.corner_vertices[self.starts[face] : self.starts[face + 1]]]
            place = int(corner - self.starts[face])
            sides = [_unit(corners[(place + k) % len(corners)] - corners[place]) for k in (1, -1)]
            across = _unit(np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0))
            normal += across * np.arccos(np.clip(sides[0] @ sides[1], -1.0, 1.0))
        return _unit(normal) if normal.any() else _unit(self.vertices[vertex])

    @cached_property
    def tree(self) -> BVHTree:
        """A tree of the faces."""
        faces = np.split(self.corner_vertices, self.starts[1:-1]) if len(self.starts) > 1 else []
        return BVHTree.FromPolygons(self.vertices.tolist(), [face.tolist() for face in faces])


@dataclass(frozen=True)
class SnapTarget:
    """One object or instance that a transform can snap to.

    Attributes:
        matrix: (4, 4) from its space to the world.
        low, high: (3,) bounds in its space.
        surface: whether it hides what is behind it; not if it is displayed as a wireframe or as bounds.
        read: reads the elements.
        original: name of the object that Blender casts rays at; empty for an instance or a mesh in Edit Mode.

    """

    matrix: Floats
    low: Floats
    high: Floats
    surface: bool
    read: Callable[[], SnapMesh]
    original: str = ""

    @cached_property
    def mesh(self) -> SnapMesh:
        """The elements."""
        return self.read()

    def cast(self, origin: Floats, direction: Floats) -> RayHit | None:
        """Where a ray in the space of the object hits a face first."""
        if self.original:
            hit, place, normal, face = self._evaluated().ray_cast(Vector(origin), Vector(direction))
            return (np.array(place), np.array(normal), face) if hit else None
        place, normal, face, _ = self.mesh.tree.ray_cast(Vector(origin), Vector(direction))
        return None if place is None else (np.array(place), np.array(normal), face)

    def closest(self, point: Floats) -> Floats | None:
        """The point of a face closest to a point, both in the space of the object; None without faces."""
        if self.original:
            found, place, _, _ = self._evaluated().closest_point_on_mesh(Vector(point))
            return np.array(place) if found else None
        place = self.mesh.tree.find_nearest(Vector(point))[0]
        return None if place is None else np.array(place)

    def _evaluated(self) -> bpy.types.Object:
        return bpy.data.objects[self.original].evaluated_get(bpy.context.evaluated_depsgraph_get())


def read_snap_targets(context: bpy.types.Context, *, selected: bool = False) -> list[SnapTarget]:
    """The targets allowed by the settings of the scene and the visibility in the view.

    selected: include the selection too, for choosing a point of it.
    """
    allowed = _allowed(context, selected)
    names = {obj.name for obj in allowed}
    edited = {obj.name for obj in context.objects_in_mode} if context.mode != "OBJECT" else set()
    targets = [_edited_mesh(obj, selected) for obj in allowed if obj.name in edited and obj.type == "MESH"]
    targets += [_point(obj) for obj in allowed if obj.type in POINTS and obj.instance_type == "NONE"]
    targets += [_bones(obj) for obj in allowed if obj.type == "ARMATURE" and obj.name not in edited]
    targets += [_curve_points(obj) for obj in allowed if obj.type == "CURVE"]
    shared: dict[int, SnapMesh] = {}
    for shown in context.evaluated_depsgraph_get().object_instances:
        owner = (shown.parent if shown.is_instance else shown.object).original
        data = shown.object.data
        is_read = owner.name in edited and not shown.is_instance
        if owner.name in names and isinstance(data, bpy.types.Mesh) and not is_read:
            targets += _mesh_target(shown, owner, data, shared)
    return [target for target in targets if np.isfinite(target.low).all()]


def _allowed(context: bpy.types.Context, selected: bool) -> list[bpy.types.Object]:
    tools, space, active = context.scene.tool_settings, context.space_data, context.view_layer.objects.active
    is_view = isinstance(space, bpy.types.SpaceView3D)

    def allows(obj: bpy.types.Object) -> bool:
        if not obj.visible_get() or (is_view and not obj.visible_in_viewport_get(space)):
            return False
        if selected:
            return True
        if tools.use_snap_selectable and obj.hide_select:
            return False
        if context.mode == "OBJECT":
            return not _moves_with_selection(obj)
        if obj == active:
            return bool(tools.use_snap_self)
        return bool(tools.use_snap_edit if obj.mode == "EDIT" else tools.use_snap_nonedit)

    return [obj for obj in context.view_layer.objects if allows(obj)]


def _moves_with_selection(obj: bpy.types.Object | None) -> bool:
    while obj is not None:
        if obj.select_get():
            return True
        obj = obj.parent
    return False


def _mesh_target(
    shown: bpy.types.DepsgraphObjectInstance, owner: bpy.types.Object, data: bpy.types.Mesh, shared: dict[int, SnapMesh]
) -> Iterator[SnapTarget]:
    if shown.object.display_type == "BOUNDS" or not len(data.vertices):
        return
    surface = shown.object.display_type != "WIRE" and not getattr(shown.object, "hide_surface_pick", False)
    matrix = as_matrix(shown.matrix_world)
    if shown.is_instance or owner.type != "MESH":
        # Blender reuses this object for the next instance: its mesh is read now.
        mesh = shared.get(data.as_pointer()) or shared.setdefault(data.as_pointer(), _read_mesh(data))
        yield SnapTarget(matrix, mesh.vertices.min(axis=0), mesh.vertices.max(axis=0), surface, lambda: mesh)
        return
    name, corners = owner.name, np.array([list(corner) for corner in shown.object.bound_box])
    yield SnapTarget(matrix, corners.min(axis=0), corners.max(axis=0), surface, lambda: _read_object(name), name)


def _read_object(name: str) -> SnapMesh:
    return _read_mesh(bpy.data.objects[name].evaluated_get(bpy.context.evaluated_depsgraph_get()).data)


def _read_mesh(mesh: bpy.types.Mesh) -> SnapMesh:
    corners, starts = read_corners(mesh)
    used = mesh.attributes.get(".corner_edge")
    edges = read_collection(*((mesh.loops, "edge_index") if used is None else (used.data, "value")), 1, np.int32)
    return SnapMesh(read_positions(mesh).astype(np.float64), read_edges(mesh), corners, edges, starts)


def _edited_mesh(obj: bpy.types.Object, selected: bool) -> SnapTarget:
    """The cage of a mesh in Edit Mode without hidden elements, and without elements that move with the selection."""
    mesh = _read_edit_mesh(bmesh.from_edit_mesh(obj.data), selected)
    low, high = (mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)) if len(mesh.vertices) else (_NONE, _NONE)
    return SnapTarget(as_matrix(obj.matrix_world), low, high, obj.display_type not in ("WIRE", "BOUNDS"), lambda: mesh)


_NONE = np.full(3, np.nan)


def _read_edit_mesh(content: Any, selected: bool) -> SnapMesh:
    verts = [vert for vert in content.verts if not vert.hide and (selected or not vert.select)]
    number = {vert: index for index, vert in enumerate(verts)}
    edges = [edge for edge in content.edges if not edge.hide and all(vert in number for vert in edge.verts)]
    edge_number = {edge: index for index, edge in enumerate(edges)}
    faces = [face for face in content.faces if not face.hide and all(vert in number for vert in face.verts)]
    loops = [loop for face in faces for loop in face.loops]
    return SnapMesh(
        np.array([list(vert.co) for vert in verts], np.float64).reshape(-1, 3),
        np.array([[number[vert] for vert in edge.verts] for edge in edges], np.int32).reshape(-1, 2),
        np.array([number[loop.vert] for loop in loops], np.int32),
        np.array([edge_number[loop.edge] for loop in loops], np.int32),
        np.cumsum([0] + [len(face.loops) for face in faces]).astype(np.int32),
    )


def _point(obj: bpy.types.Object) -> SnapTarget:
    return _of_points(obj, np.zeros((1, 3)))


def _bones(obj: bpy.types.Object) -> SnapTarget:
    ends = [list(end) for bone in obj.pose.bones for end in (bone.head, bone.tail)]
    return _of_points(obj, np.array(ends, np.float64), np.arange(len(ends), dtype=np.int32).reshape(-1, 2))


def _curve_points(obj: bpy.types.Object) -> SnapTarget:
    """Control points of a curve without a surface; a curve with a surface is a mesh."""
    splines = [spline for spline in obj.data.splines if max(len(spline.bezier_points), len(spline.points)) > 1]
    points = [list(point.co)[:3] for spline in splines for point in (*spline.bezier_points, *spline.points)]
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    has_surface = evaluated.to_mesh() is not None and len(evaluated.to_mesh().polygons) > 0
    evaluated.to_mesh_clear()
    return _of_points(obj, np.array([] if has_surface else points, np.float64))


def _of_points(obj: bpy.types.Object, points: Floats, edges: Indices = NO_EDGES) -> SnapTarget:
    mesh = SnapMesh(points.reshape(-1, 3), edges)
    low, high = (mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)) if len(mesh.vertices) else (_NONE, _NONE)
    return SnapTarget(as_matrix(obj.matrix_world), low, high, False, lambda: mesh)


def _unit(vector: Floats) -> Floats:
    length = float(np.linalg.norm(vector))
    return vector / length if length > 0 else vector
