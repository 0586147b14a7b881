# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes for the window: an object to drag, and a wall whose face is at x = WALL_FACE."""

from __future__ import annotations

import math
from typing import Any

import bmesh
import bpy
import mathutils

WALL_FACE = 1.9
WALL_THICKNESS = 0.2
HALF = 0.5  # half size of the dragged object along x


def clear() -> None:
    """Remove every object, in Object Mode, and reset the scene's settings."""
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    scene = bpy.context.scene
    scene.stiv.live_transforms = scene.stiv.live_guard = False
    scene.stiv.passing_pairs.clear()
    scene.stiv.excluded = ""
    response = "responders", "object_response", "slide_out_of_axis", "smoothness", "tight", "constraints"
    for name in ("separation", "interference", *response):
        scene.stiv.property_unset(name)
    tools = scene.tool_settings
    tools.transform_pivot_point, tools.snap_target, tools.snap_elements = "MEDIAN_POINT", "CLOSEST", {"INCREMENT"}
    tools.use_snap_align_rotation = False
    tools.use_snap = tools.use_proportional_edit = tools.use_proportional_connected = False
    tools.proportional_edit_falloff, tools.proportional_size = "SMOOTH", 1.0
    scene.transform_orientation_slots[0].type = "GLOBAL"
    scene.cursor.location = (0.0, 0.0, 0.0)


def look_from_above(area: Any) -> None:
    """Parallel view along -z: x to the right, y upwards."""
    view = area.spaces.active.region_3d
    view.view_perspective = "ORTHO"
    view.view_rotation = mathutils.Quaternion()
    view.view_location, view.view_distance = (0.0, 0.0, 0.0), 9.0
    view.update()


def look_from_corner(area: Any) -> None:
    """Perspective view that shows depth, for pictures."""
    look_from_above(area)
    view = area.spaces.active.region_3d
    view.view_perspective = "PERSP"
    view.view_rotation = mathutils.Euler((math.radians(58.0), 0.0, math.radians(-28.0))).to_quaternion()
    view.update()


def add_mesh(name: str, build: Any, location: tuple = (0.0, 0.0, 0.0)) -> Any:
    """A mesh object; `build` fills a bmesh."""
    mesh = bpy.data.meshes.new(name)
    content = bmesh.new()
    build(content)
    content.to_mesh(mesh)
    content.free()
    obj = bpy.data.objects.new(name, mesh)
    obj.location = location
    bpy.context.collection.objects.link(obj)
    return obj


def add_wall() -> Any:
    """A thin upright box."""
    size = mathutils.Matrix.Diagonal((WALL_THICKNESS, 4.0, 3.0, 1.0))
    centre = (WALL_FACE + WALL_THICKNESS / 2.0, 0.0, 0.0)
    return add_mesh("Wall", lambda content: bmesh.ops.create_cube(content, size=1.0, matrix=size), centre)


def add_box() -> Any:
    """A box of edge 1 in the middle."""
    return add_mesh("Box", lambda content: bmesh.ops.create_cube(content, size=2.0 * HALF))


def add_pair() -> Any:
    """Two boxes, one above the other in the view, for a selection of both."""
    upper = add_mesh("Upper", lambda content: bmesh.ops.create_cube(content, size=0.4), (0.0, 1.0, 0.0))
    add_mesh("Lower", lambda content: bmesh.ops.create_cube(content, size=0.4), (0.0, -1.0, 0.0))
    return upper


def add_target() -> Any:
    """A box, and to the left of it a block whose upper face is at z = 0.25 and whose nearest corner is (-1, 1)."""
    add_box()
    return add_mesh("Block", lambda content: bmesh.ops.create_cube(content, size=0.5), (-1.25, 1.25, 0.0))


def add_strip() -> Any:
    """A strip of eight quads from x = -1.2 to 1.2."""

    def build(content: bmesh.types.BMesh) -> None:
        scale = mathutils.Matrix.Diagonal((1.2, 0.2, 1.0, 1.0))
        bmesh.ops.create_grid(content, x_segments=8, y_segments=1, size=1.0, matrix=scale)

    return add_mesh("Strip", build)


def add_cage() -> Any:
    """A subdivided cube under a Subdivision Surface modifier."""

    def build(content: bmesh.types.BMesh) -> None:
        bmesh.ops.create_cube(content, size=2.0 * HALF)
        bmesh.ops.subdivide_edges(content, edges=content.edges[:], cuts=2, use_grid_fill=True)

    cage = add_mesh("Cage", build)
    cage.modifiers.new("Subdivision", "SUBSURF").levels = 2
    return cage


def levels() -> tuple[int, int]:
    """The levels of the cage's subdivision in the viewport and in the render."""
    modifier = bpy.data.objects["Cage"].modifiers[0]
    return modifier.levels, modifier.render_levels


def set_levels(viewport: int, render: int) -> None:
    """Set both."""
    modifier = bpy.data.objects["Cage"].modifiers[0]
    modifier.levels, modifier.render_levels = viewport, render


def add_ball() -> Any:
    """A sphere of triangles."""
    return add_mesh("Ball", lambda content: bmesh.ops.create_icosphere(content, subdivisions=3, radius=HALF))


def add_ball_in_lattice() -> tuple[Any, Any]:
    """A sphere and the lattice that deforms it."""
    ball = add_ball()
    data = bpy.data.lattices.new("Lattice")
    data.points_u = data.points_v = data.points_w = 4
    lattice = bpy.data.objects.new("Lattice", data)
    lattice.scale = (1.3, 1.3, 1.3)
    bpy.context.collection.objects.link(lattice)
    ball.modifiers.new("Lattice", "LATTICE").object = lattice
    return ball, lattice


def add_curve() -> Any:
    """A bevelled Bezier curve that stands upright."""
    data = bpy.data.curves.new("Curve", "CURVE")
    data.dimensions, data.bevel_depth = "3D", 0.1
    spline = data.splines.new("BEZIER")
    spline.bezier_points.add(2)
    for place, point in zip((-1, 0, 1), spline.bezier_points, strict=True):
        point.co = (0.3 * place * place, 0, HALF * place)
        point.handle_left_type = point.handle_right_type = "AUTO"
    curve = bpy.data.objects.new("Curve", data)
    bpy.context.collection.objects.link(curve)
    return curve


def add_mirrored_piece() -> Any:
    """A plate like that of an armour, mirrored at y = 0, thick, bevelled and smoothly shaded, before a round body."""

    def build_plate(content: bmesh.types.BMesh) -> None:
        bmesh.ops.create_grid(content, x_segments=4, y_segments=4, size=1.0)
        for vertex in content.verts:
            x, y = vertex.co.x, (vertex.co.y + 1) / 2
            vertex.co = (0.5 + 0.3 * y * y, 1.2 * y, 0.7 * x)

    def build_body(content: bmesh.types.BMesh) -> None:
        bmesh.ops.create_icosphere(content, subdivisions=4, radius=0.45)

    add_mesh("Body", build_body, (1.4, 0.2, 0.1))
    piece = add_mesh("Piece", build_plate)
    piece.modifiers.new("Mirror", "MIRROR").use_axis = (False, True, False)
    piece.modifiers.new("Solidify", "SOLIDIFY").thickness = 0.15
    bevel = piece.modifiers.new("Bevel", "BEVEL")
    bevel.width, bevel.segments, bevel.limit_method = 0.03, 2, "NONE"
    piece.modifiers.new("Smooth by Angle", "NODES").node_group = smooth_by_angle()
    return piece


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


def select_only(obj: Any) -> None:
    """Select one object and make it active."""
    bpy.context.view_layer.update()  # it lists removed objects as None until then
    for other in bpy.context.view_layer.objects:
        other.select_set(other == obj)
    bpy.context.view_layer.objects.active = obj
    bpy.context.view_layer.update()


def evaluated_extent(name: str) -> float:
    """The largest x of an object as Blender evaluates it."""
    graph = bpy.context.evaluated_depsgraph_get()
    obj = bpy.data.objects[name].evaluated_get(graph)
    mesh = obj.to_mesh()
    largest = max((obj.matrix_world @ vertex.co).x for vertex in mesh.vertices)
    obj.to_mesh_clear()
    return largest
