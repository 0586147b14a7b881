# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes made through bpy, and looking at them without the package under test."""

from itertools import combinations
from typing import Any

import bmesh
import bpy
import numpy as np
from mathutils import Vector
from oracles import rational
from oracles.parting import parting_motion

CUBE = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
CUBE_FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def add(name: str, data: Any, location: Any = (0, 0, 0), **properties: Any) -> Any:
    """A new object in the scene, not selected."""
    ob = bpy.data.objects.new(name, data)
    ob.location = location
    for key, value in properties.items():
        setattr(ob, key, value)
    bpy.context.collection.objects.link(ob)
    bpy.context.view_layer.update()
    return ob


def mesh(name: str, vertices: Any, faces: Any, edges: Any = ()) -> Any:
    """New mesh data."""
    data = bpy.data.meshes.new(name)
    data.from_pydata([tuple(v) for v in vertices], list(edges), [tuple(f) for f in faces])
    return data


def add_cube(name: str, location: Any = (0, 0, 0), size: float = 1.0, **properties: Any) -> Any:
    """A cube of this half width."""
    return add(name, mesh(name, np.array(CUBE) * size, CUBE_FACES), location, **properties)


def add_grid(name: str, count: int, size: float = 1.0, location: Any = (0, 0, 0), **properties: Any) -> Any:
    """A flat square of count x count quads, of this half width."""
    axis = np.linspace(-size, size, count + 1)
    vertices = [(x, y, 0.0) for y in axis for x in axis]
    n = count + 1
    faces = [
        (r * n + c, r * n + c + 1, (r + 1) * n + c + 1, (r + 1) * n + c) for r in range(count) for c in range(count)
    ]
    return add(name, mesh(name, vertices, faces), location, **properties)


def cube_above_floor(**properties: Any) -> Any:
    """A cube of edge 2 whose lowest point is 1 above a floor at z = 0; the cube."""
    add_grid("Floor", 4, 4.0)
    return add_cube("Cübe A", (0.3, 0, 2), **properties)


def add_lattice(name: str, resolution: Any, location: Any = (0, 0, 0), **properties: Any) -> Any:
    """A lattice at rest."""
    data = bpy.data.lattices.new(name)
    data.points_u, data.points_v, data.points_w = resolution
    return add(name, data, location, **properties)


def add_modifier(ob: Any, kind: str, name: str = "", **properties: Any) -> Any:
    """A modifier with these settings."""
    modifier = ob.modifiers.new(name or kind.title(), kind)
    for key, value in properties.items():
        setattr(modifier, key, value)
    return modifier


def smooth_by_angle() -> Any:
    """A node group that shades edges of less than half a radian smooth, as Blender's own asset does."""
    tree = bpy.data.node_groups.new("Smooth by Angle", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    source, result = (tree.nodes.new(f"NodeGroup{way}") for way in ("Input", "Output"))
    angle, is_less = tree.nodes.new("GeometryNodeInputMeshEdgeAngle"), tree.nodes.new("FunctionNodeCompare")
    smooth = tree.nodes.new("GeometryNodeSetShadeSmooth")
    smooth.domain, is_less.operation = "EDGE", "LESS_EQUAL"
    is_less.inputs[1].default_value = 0.5
    tree.links.new(source.outputs[0], smooth.inputs[0])
    tree.links.new(angle.outputs[0], is_less.inputs[0])
    tree.links.new(is_less.outputs[0], smooth.inputs[2])
    tree.links.new(smooth.outputs[0], result.inputs[0])
    return tree


def select(*objects: Any) -> None:
    """Select these objects alone; the first becomes active."""
    bpy.context.view_layer.update()
    for ob in bpy.context.view_layer.objects:
        ob.select_set(ob in objects)
    bpy.context.view_layer.objects.active = objects[0] if objects else None
    bpy.context.view_layer.update()


def edit_mode(*objects: Any) -> None:
    """Enter Edit Mode with these objects."""
    select(*objects)
    bpy.ops.object.mode_set(mode="EDIT")


def evaluated(ob: Any) -> np.ndarray:
    """World positions that Blender evaluates, (n, 3), by way of a copy of the mesh."""
    bpy.context.view_layer.update()
    shown = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    copy = shown.to_mesh()
    local = [v.co.copy() for v in copy.vertices]
    shown.to_mesh_clear()
    return np.array([shown.matrix_world @ co for co in local], float).reshape(-1, 3)


def shift(x: float = 0, y: float = 0, z: float = 0) -> np.ndarray:
    """A translation, (4, 4)."""
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def turn(angle: float, axis: str, pivot: Any = (0, 0, 0)) -> np.ndarray:
    """A rotation about an axis through a pivot, (4, 4)."""
    k = "XYZ".index(axis)
    i, j = (k + 1) % 3, (k + 2) % 3
    matrix = np.eye(4)
    matrix[i, i] = matrix[j, j] = np.cos(angle)
    matrix[i, j], matrix[j, i] = -np.sin(angle), np.sin(angle)
    matrix[:3, 3] = np.array(pivot) - matrix[:3, :3] @ np.array(pivot)
    return matrix


def stretch(factors: Any, pivot: Any = (0, 0, 0)) -> np.ndarray:
    """A scaling along the world's axes about a pivot, (4, 4)."""
    matrix = np.diag([*np.broadcast_to(factors, 3), 1.0])
    matrix[:3, 3] = np.array(pivot) - matrix[:3, :3] @ np.array(pivot)
    return matrix


def moved(matrix: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Points, (n, 3), after an affine map."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def matrices(objects: list[Any]) -> np.ndarray:
    """World matrices, (n, 4, 4)."""
    return np.array([np.array(ob.matrix_world) for ob in objects])


def snapshot() -> dict[str, Any]:
    """Everything of the scene that an edit might touch, to the last bit."""
    return {ob.name: _object(ob) for ob in bpy.data.objects} | {
        "mode": bpy.context.mode,
        "active": getattr(bpy.context.view_layer.objects.active, "name", None),
        "objects": sorted(bpy.data.objects.keys()),
        "meshes": sorted(bpy.data.meshes.keys()),
    }


def _object(ob: Any) -> dict[str, Any]:
    values = {
        name: tuple(getattr(ob, name))
        for name in ("location", "rotation_euler", "rotation_quaternion", "rotation_axis_angle", "scale",
                     "delta_location", "delta_scale")
    }  # fmt: skip
    values["world"] = tuple(tuple(row) for row in ob.matrix_world)
    values["selected"] = ob.select_get() if ob.name in bpy.context.view_layer.objects else None
    values["modifiers"] = [(m.name, m.show_viewport) for m in ob.modifiers]
    if ob.type == "MESH":
        if ob.mode == "EDIT":
            ob.update_from_editmode()
        values["points"] = [tuple(v.co) for v in ob.data.vertices]
        values["selection"] = [v.select for v in ob.data.vertices]
        if ob.data.shape_keys:
            values["keys"] = [[tuple(v.co) for v in key.data] for key in ob.data.shape_keys.key_blocks]
    elif ob.type == "LATTICE":
        values["points"] = [tuple(Vector(point.co_deform)) for point in ob.data.points]
        values["selection"] = [point.select for point in ob.data.points]
    return values


def as_rendered() -> None:
    """Change the file itself to show what it renders."""
    render = bpy.context.scene.render
    render.simplify_subdivision = render.simplify_subdivision_render
    for ob in bpy.data.objects:
        ob.hide_set(False)
        ob.hide_viewport = ob.hide_render
        for modifier in ob.modifiers:
            modifier.show_viewport = modifier.show_render
            if modifier.type == "SUBSURF":
                modifier.levels = modifier.render_levels
    bpy.context.view_layer.update()


def shown_triangles(name: str) -> np.ndarray:
    """World positions of the triangles that Blender shows of an object, (t, 3, 3)."""
    graph = bpy.context.evaluated_depsgraph_get()
    shown = bpy.data.objects[name].evaluated_get(graph)
    mesh = shown.to_mesh()
    mesh.calc_loop_triangles()
    points = np.array([shown.matrix_world @ vertex.co for vertex in mesh.vertices], float).reshape(-1, 3)
    corners = points[np.array([list(t.vertices) for t in mesh.loop_triangles], int).reshape(-1, 3)]
    shown.to_mesh_clear()
    return corners


def meet(first: str, second: str) -> int:
    """How many pairs of their triangles meet; pairs with boxes apart are not looked at."""
    one, two = shown_triangles(first), shown_triangles(second)
    low, high = np.maximum(one.min(1)[:, None], two.min(1)), np.minimum(one.max(1)[:, None], two.max(1))
    near = np.argwhere((low <= high).all(axis=2))
    return sum(rational.triangles_intersect((0, 1, 2), (3, 4, 5), np.vstack([one[a], two[b]])) for a, b in near)


def deepest() -> float:
    """How far any two objects with a surface cut into each other, in roundings of their coordinates; 0 if none do."""
    shapes = [shown_triangles(ob.name) for ob in bpy.context.view_layer.objects if ob.type == "MESH"]
    depth = 0.0
    for one, two in combinations(shapes, 2):
        low, high = np.maximum(one.min(1)[:, None], two.min(1)), np.minimum(one.max(1)[:, None], two.max(1))
        near = np.argwhere((low <= high).all(axis=2))
        depth = max([depth, *(parting_motion(one[a], two[b]) for a, b in near)])
    return depth / float(np.spacing(np.float32(max(abs(each).max() for each in shapes))))


def add_bowl(radius: float, rim: float, segments: int = 32) -> Any:
    """A sphere without what is above the height `rim`, open there."""
    content = bmesh.new()
    bmesh.ops.create_uvsphere(content, u_segments=segments, v_segments=segments, radius=radius)
    bmesh.ops.delete(content, geom=[vertex for vertex in content.verts if vertex.co.z > rim], context="VERTS")
    data = bpy.data.meshes.new("Bowl")
    content.to_mesh(data)
    content.free()
    return add("Bowl", data)
