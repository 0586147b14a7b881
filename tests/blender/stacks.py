# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces with the modifier stacks of artists, above a body, and random combinations of modifiers."""

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
from building import add, add_lattice, add_modifier, mesh, select, smooth_by_angle


def add_body() -> Any:
    """A ball of radius 1 whose top is 0.25 below the lowest pieces."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, location=(0, 0, -1.35))
    bpy.context.object.name = "Body"
    return bpy.context.object


def add_sheet(count: int = 6, low: float = -1.0) -> Any:
    """A bumpy sheet of count x count quads from x = low to 1."""
    axis = np.linspace(-1, 1, count + 1)
    across = np.linspace(low, 1, count + 1)
    points = [(x, y, 0.06 * np.sin(3 * x + 1) * np.cos(2 * y)) for y in axis for x in across]
    n = count + 1
    faces = [
        (r * n + c, r * n + c + 1, (r + 1) * n + c + 1, (r + 1) * n + c) for r in range(count) for c in range(count)
    ]
    return add("Piece", mesh("Piece", points, faces))


def add_block() -> Any:
    """A box of 2 x 2 x 1 quads."""
    data = bpy.data.meshes.new("Piece")
    import bmesh

    made = bmesh.new()
    bmesh.ops.create_cube(made, size=1.0)
    bmesh.ops.subdivide_edges(made, edges=made.edges[:], cuts=1, use_grid_fill=True)
    bmesh.ops.scale(made, vec=(1.6, 1.6, 0.5), verts=made.verts[:])
    bmesh.ops.translate(made, vec=(0, 0, 0.3), verts=made.verts[:])
    made.to_mesh(data)
    made.free()
    return add("Piece", data)


def add_strip() -> Any:
    """A profile of edges, for Screw."""
    return add("Piece", mesh("Piece", [(0.3, 0, 0.1 + z / 4) for z in range(5)], [], [(k, k + 1) for k in range(4)]))


def add_arm() -> Any:
    """An armature of two bones along x, the second one bent."""
    arm = add("Arm", bpy.data.armatures.new("Arm"))
    select(arm)
    bpy.ops.object.mode_set(mode="EDIT")
    first, second = (arm.data.edit_bones.new(name) for name in ("First", "Second"))
    first.head, first.tail, second.tail = (-1, 0, 0), (0, 0, 0), (1, 0, 0)
    second.head, second.parent = (0, 0, 0), first
    bpy.ops.object.mode_set(mode="OBJECT")
    bone = arm.pose.bones["Second"]
    bone.rotation_mode, bone.rotation_euler = "XYZ", (0.3, 0.2, 0.3)
    return arm


def skin(ob: Any) -> None:
    """Weights that pass smoothly from the first bone to the second."""
    for name, sign in (("First", -1), ("Second", 1)):
        group = ob.vertex_groups.new(name=name)
        for vertex in ob.data.vertices:
            group.add([vertex.index], float(1 / (1 + np.exp(-4 * sign * vertex.co.x))), "REPLACE")


def along_normals(distance: float = 0.1) -> Any:
    """A node group that moves vertices along their normals."""
    tree = bpy.data.node_groups.new("Along Normals", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    source, result = (tree.nodes.new(f"NodeGroup{way}") for way in ("Input", "Output"))
    place, normal = tree.nodes.new("GeometryNodeSetPosition"), tree.nodes.new("GeometryNodeInputNormal")
    scale = tree.nodes.new("ShaderNodeVectorMath")
    scale.operation = "SCALE"
    scale.inputs["Scale"].default_value = distance
    tree.links.new(source.outputs[0], place.inputs[0])
    tree.links.new(normal.outputs[0], scale.inputs[0])
    tree.links.new(scale.outputs[0], place.inputs["Offset"])
    tree.links.new(place.outputs[0], result.inputs[0])
    return tree


def add_curve() -> Any:
    """A bent curve along x."""
    data = bpy.data.curves.new("Curve", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("BEZIER")
    spline.bezier_points.add(1)
    for point, place in zip(spline.bezier_points, ((-3, 0, 0), (3, 0.5, 0.6)), strict=True):
        point.co, point.handle_left_type, point.handle_right_type = place, "AUTO", "AUTO"
    return add("Curve", data)


def subdivided(ob: Any, levels: int = 1) -> None:
    add_modifier(ob, "SUBSURF", levels=levels, render_levels=levels)


def on_sheet(kind: str, **settings: Any) -> Callable[[], Any]:
    def make() -> Any:
        ob = add_sheet()
        add_modifier(ob, kind, **settings)
        return ob

    return make


def mirrored() -> Any:
    ob = add_sheet(low=0.0)
    add_modifier(ob, "MIRROR")
    return ob


def mirrored_and_smooth() -> Any:
    ob = mirrored()
    subdivided(ob)
    add_modifier(ob, "NODES").node_group = smooth_by_angle()
    return ob


def thick_and_smooth() -> Any:
    ob = on_sheet("SOLIDIFY", thickness=0.1)()
    subdivided(ob)
    return ob


def thick_and_triangulated() -> Any:
    ob = on_sheet("SOLIDIFY", thickness=0.1)()
    add_modifier(ob, "TRIANGULATE")
    return ob


def triangulated_and_pushed() -> Any:
    ob = pushed_by_nodes()
    add_modifier(ob, "TRIANGULATE")
    ob.modifiers.move(1, 0)
    return ob


def bevelled() -> Any:
    ob = add_block()
    add_modifier(ob, "BEVEL", width=0.05, segments=2, limit_method="NONE")
    add_modifier(ob, "NODES").node_group = smooth_by_angle()
    return ob


def bevelled_and_smooth() -> Any:
    ob = bevelled()
    ob.modifiers.remove(ob.modifiers[1])
    subdivided(ob)
    return ob


def mirrored_bevelled_shaded() -> Any:
    ob = add_sheet(3, low=0.0)
    add_modifier(ob, "MIRROR")
    add_modifier(ob, "SOLIDIFY", thickness=0.15)
    add_modifier(ob, "BEVEL", width=0.03, segments=2, limit_method="NONE")
    add_modifier(ob, "NODES").node_group = smooth_by_angle()
    return ob


def pushed_by_nodes() -> Any:
    ob = add_sheet()
    add_modifier(ob, "NODES").node_group = along_normals()
    return ob


def pushed_and_smooth() -> Any:
    ob = pushed_by_nodes()
    subdivided(ob)
    return ob


def posed() -> Any:
    arm, ob = add_arm(), add_sheet()
    skin(ob)
    add_modifier(ob, "ARMATURE", object=arm)
    return ob


def posed_and_smooth() -> Any:
    ob = posed()
    subdivided(ob)
    return ob


def along_a_curve() -> Any:
    curve, ob = add_curve(), add_sheet()
    add_modifier(ob, "CURVE", object=curve)
    return ob


def warped() -> Any:
    start, end, ob = add("From", None, (0.2, 0, 0)), add("To", None, (0.2, 0.1, 0.3)), add_sheet()
    add_modifier(ob, "WARP", object_from=start, object_to=end, falloff_radius=2)
    return ob


def hooked() -> Any:
    hook, ob = add("Hook", None, (0, 0, 0.2)), add_sheet()
    modifier = add_modifier(ob, "HOOK", object=hook, falloff_radius=0)
    modifier.vertex_indices_set(range(10))
    return ob


def hooked_and_triangulated() -> Any:
    ob = hooked()
    add_modifier(ob, "TRIANGULATE")
    add_modifier(ob, "SMOOTH", factor=0.3)
    return ob


def in_a_lattice() -> Any:
    lattice, ob = add_lattice("Lattice", (2, 3, 4), scale=(3, 3, 3)), add_sheet()
    lattice.data.points[3].co_deform.x += 0.2
    add_modifier(ob, "LATTICE", object=lattice)
    return ob


def in_a_cage() -> Any:
    bpy.ops.mesh.primitive_cube_add(size=4)
    cage, ob = bpy.context.object, add_sheet(4)
    cage.display_type, cage.hide_render = "WIRE", True
    modifier = add_modifier(ob, "MESH_DEFORM", object=cage, precision=3)
    select(ob)
    bpy.ops.object.meshdeform_bind(modifier=modifier.name)
    cage.data.vertices[0].co.z -= 0.3
    cage.hide_set(True)
    return ob


def sculpted() -> Any:
    ob = add_sheet(4)
    modifier = add_modifier(ob, "MULTIRES")
    select(ob)
    bpy.ops.object.multires_subdivide(modifier=modifier.name)
    return ob


def relaxed_after_posing() -> Any:
    ob = posed()
    add_modifier(ob, "CORRECTIVE_SMOOTH", iterations=3)
    return ob


def relaxed_and_smooth() -> Any:
    ob = relaxed_after_posing()
    subdivided(ob)
    return ob


def posed_by_quaternions() -> Any:
    ob = posed()
    ob.modifiers[0].use_deform_preserve_volume = True
    return ob


def displaced_by_a_texture() -> Any:
    texture = bpy.data.textures.new("Clouds", "CLOUDS")
    return on_sheet("DISPLACE", strength=0.1, texture=texture)()


def screwed() -> Any:
    ob = add_strip()
    add_modifier(ob, "SCREW", steps=8, render_steps=8)
    return ob


def welded() -> Any:
    ob = add_sheet()
    ob.data.vertices[8].co = ob.data.vertices[9].co
    add_modifier(ob, "WELD", merge_threshold=0.001)
    return ob


def shaded_by_angle() -> Any:
    ob = add_sheet()
    add_modifier(ob, "NODES").node_group = smooth_by_angle()
    return ob


def with_a_key(kind: str = "", **settings: Any) -> Callable[[], Any]:
    """A sheet with a shape key that is shown at 0.7 and active."""

    def make() -> Any:
        ob = add_sheet()
        ob.shape_key_add(name="Basis")
        key = ob.shape_key_add(name="Raised")
        for point in list(key.data)[:20]:
            point.co.z += 0.2
        key.value, ob.active_shape_key_index = 0.7, 1
        if kind:
            add_modifier(ob, kind, **settings)
        return ob

    return make


def shared_and_mirrored() -> Any:
    """A half sheet with a second user of its mesh to the side; both are mirrored."""
    ob = mirrored()
    other = add("Piece 2", ob.data, (0, 4, 0))
    add_modifier(other, "MIRROR")
    return ob


def at_the_start(kind: str) -> Callable[[], Any]:
    """A sheet whose simulation has not begun."""

    def make() -> Any:
        bpy.context.scene.frame_set(1)
        return on_sheet(kind)()

    return make


def as_curve() -> Any:
    """A curve along y with a round profile."""
    ob = add_curve()
    ob.name, ob.data.bevel_depth, ob.location.z = "Piece", 0.1, 0.3
    return ob


def as_text() -> Any:
    """Text that is extruded."""
    data = bpy.data.curves.new("Text", "FONT")
    data.body, data.extrude, data.align_x = "STIV", 0.05, "CENTER"
    return add("Piece", data, (0, -0.3, 0.1))


STACKS = {
    "Mirror": mirrored,
    "Mirror, Subdivision Surface, Smooth by Angle": mirrored_and_smooth,
    "Mirror, Solidify, Bevel, Smooth by Angle": mirrored_bevelled_shaded,
    "Array": on_sheet("ARRAY", count=2, use_relative_offset=False, use_constant_offset=True,
                      constant_offset_displace=(0, 0, 0.4)),
    "Solidify": on_sheet("SOLIDIFY", thickness=0.1),
    "Solidify, Subdivision Surface": thick_and_smooth,
    "Solidify, Triangulate": thick_and_triangulated,
    "Bevel, Smooth by Angle": bevelled,
    "Bevel, Subdivision Surface": bevelled_and_smooth,
    "Geometry Nodes": pushed_by_nodes,
    "Triangulate, Geometry Nodes": triangulated_and_pushed,
    "Geometry Nodes, Subdivision Surface": pushed_and_smooth,
    "Armature": posed,
    "Armature, Subdivision Surface": posed_and_smooth,
    "Armature, Corrective Smooth": relaxed_after_posing,
    "Armature, Corrective Smooth, Subdivision Surface": relaxed_and_smooth,
    "Armature by dual quaternions": posed_by_quaternions,
    "Displace by a texture": displaced_by_a_texture,
    "Displace": on_sheet("DISPLACE", strength=0.1),
    "Curve": along_a_curve,
    "Simple Deform": on_sheet("SIMPLE_DEFORM", deform_method="BEND", deform_axis="Y", angle=0.5),
    "Twist": on_sheet("SIMPLE_DEFORM", deform_method="TWIST", deform_axis="X", angle=0.3),
    "Warp": warped,
    "Wave": on_sheet("WAVE", height=0.1, time_offset=-20),
    "Cast": on_sheet("CAST", factor=0.2),
    "Smooth": on_sheet("SMOOTH", factor=0.5, iterations=2),
    "Corrective Smooth": on_sheet("CORRECTIVE_SMOOTH", use_only_smooth=True),
    "Laplacian Smooth": on_sheet("LAPLACIANSMOOTH", lambda_factor=0.1),
    "Weld": welded,
    "Multiresolution": sculpted,
    "Mesh Deform": in_a_cage,
    "Hook": hooked,
    "Screw": screwed,
    "Lattice": in_a_lattice,
    "Wireframe": on_sheet("WIREFRAME", thickness=0.05),
    "Collision": on_sheet("COLLISION"),
}  # fmt: skip

KINDS = {
    "Smooth by Angle": shaded_by_angle,
    "Hook, Triangulate, Smooth": hooked_and_triangulated,  # small motions flip quads: no Jacobian predicts these
    "Shape keys": with_a_key(),
    "Shape keys, Solidify": with_a_key("SOLIDIFY", thickness=0.1),
    "Shared mesh, Mirror": shared_and_mirrored,
    "Cloth at its start": at_the_start("CLOTH"),
    "Curve object": as_curve,
    "Text object": as_text,
}


def _kind(kind: str, **ranges: Any) -> Callable[[Any, Any], None]:
    """Adds a modifier; a pair of numbers is a range, of which a random one is taken."""

    def put(ob: Any, random: Any) -> None:
        values = {
            name: float(random.uniform(*value)) if isinstance(value, tuple) else value for name, value in ranges.items()
        }
        add_modifier(ob, kind, **values)

    return put


def _with_group(tree: Callable[[], Any]) -> Callable[[Any, Any], None]:
    def put(ob: Any, random: Any) -> None:
        add_modifier(ob, "NODES").node_group = tree()

    return put


def _posed(ob: Any, random: Any) -> None:
    arm = add_arm()
    skin(ob)
    add_modifier(ob, "ARMATURE", object=arm, use_deform_preserve_volume=bool(random.integers(2)))


def _along_curve(ob: Any, random: Any) -> None:
    add_modifier(ob, "CURVE", object=add_curve())


def _hooked(ob: Any, random: Any) -> None:
    modifier = add_modifier(ob, "HOOK", object=add("Hook", None, (0, 0, 0.1)), falloff_radius=0)
    modifier.vertex_indices_set(range(5))


MODIFIERS: list[Callable[[Any, Any], None]] = [
    _kind("ARRAY", count=2, use_relative_offset=False, use_constant_offset=True, constant_offset_displace=[0, 0, 0.5]),
    _kind("SOLIDIFY", thickness=(-0.1, 0.1)), _kind("BEVEL", width=(0.01, 0.04), segments=2, limit_method="NONE"),
    _kind("DISPLACE", strength=(-0.1, 0.1)), _kind("CAST", factor=(0, 0.2)), _kind("SMOOTH", factor=(0.1, 0.5)),
    _kind("SIMPLE_DEFORM", deform_method="BEND", deform_axis="Y", angle=(-0.5, 0.5)),
    _kind("SIMPLE_DEFORM", deform_method="TWIST", angle=(-0.3, 0.3)),
    _kind("WAVE", height=(0.02, 0.1), time_offset=-20), _kind("SUBSURF", levels=1, render_levels=2),
    _kind("CORRECTIVE_SMOOTH", use_only_smooth=True), _kind("LAPLACIANSMOOTH", lambda_factor=(0.05, 0.2)),
    _kind("WELD"), _kind("COLLISION"), _kind("TRIANGULATE"), _kind("WEIGHTED_NORMAL"),
    _kind("WIREFRAME", thickness=(0.02, 0.05)), _with_group(along_normals), _with_group(smooth_by_angle),
    _posed, _along_curve, _hooked,
]  # fmt: skip


def random_stack(random: np.random.Generator) -> Any:
    """A piece with two to four random modifiers; every third one is mirrored, first of all."""
    is_mirrored = random.integers(3) == 0
    ob = mirrored() if is_mirrored else add_sheet()
    fewest, most = (1, 3) if is_mirrored else (2, 4)
    for place in random.choice(len(MODIFIERS), random.integers(fewest, most + 1), replace=False):
        MODIFIERS[place](ob, random)
    return ob


# The trials of tests/long/stack_trials.py, of STACKS and KINDS.
COMMON = [
    "Mirror", "Mirror, Subdivision Surface, Smooth by Angle", "Mirror, Solidify, Bevel, Smooth by Angle", "Array",
    "Solidify", "Solidify, Subdivision Surface", "Bevel, Smooth by Angle", "Bevel, Subdivision Surface",
    "Smooth by Angle", "Geometry Nodes, Subdivision Surface", "Armature, Subdivision Surface",
    "Armature, Corrective Smooth", "Displace", "Curve", "Simple Deform", "Wave", "Smooth", "Weld", "Multiresolution",
    "Mesh Deform", "Hook", "Lattice", "Collision", "Shape keys, Solidify", "Shared mesh, Mirror",
    "Cloth at its start", "Curve object", "Text object",
]  # fmt: skip
