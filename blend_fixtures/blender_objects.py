# SPDX-License-Identifier: GPL-3.0-or-later
"""Convert a fixture's plain data into a Blender scene: objects, modifiers, materials, camera and light.

Loop subdivision needs the add-on to be registered.
"""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector

from blend_fixtures.scenes.fixture import (
    EmptyObject,
    Fixture,
    LatticeObject,
    Material,
    MeshObject,
    Placement,
    Subdivision,
    View,
)
from blend_fixtures.scenes.shape import Shape


def build_scene(fixture: Fixture) -> None:
    """Replace the open file with a new one that contains the fixture."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    for empty in fixture.empties:
        _add_empty(empty)
    for lattice in fixture.lattices:
        _add_lattice(lattice)
    for mesh in fixture.meshes:
        _add_mesh(mesh)
    _add_view(fixture.view)
    bpy.context.view_layer.update()


def _link(obj: bpy.types.Object, placement: Placement, parent: str | None = None) -> None:
    bpy.context.scene.collection.objects.link(obj)
    obj.location, obj.rotation_euler, obj.scale = placement.location, placement.rotation, placement.scale
    if parent:
        obj.parent = bpy.data.objects[parent]


def _add_empty(item: EmptyObject) -> None:
    _link(bpy.data.objects.new(item.name, None), item.placement)


def _add_lattice(item: LatticeObject) -> None:
    data = bpy.data.lattices.new(item.name)
    data.points_u, data.points_v, data.points_w = item.resolution
    data.interpolation_type_u = data.interpolation_type_v = data.interpolation_type_w = item.interpolation
    obj = bpy.data.objects.new(item.name, data)
    obj.hide_render = True
    _link(obj, item.placement)


def _add_mesh(item: MeshObject) -> None:
    obj = bpy.data.objects.new(item.name, _mesh(item.name, item.shape, item.smooth))
    obj.data.materials.append(_material(item.material))
    obj.color = item.material.color
    _link(obj, item.placement, item.parent)
    for group in item.groups:
        made = obj.vertex_groups.new(name=group.name)
        for vertex, weight in group.weights.items():
            made.add([vertex], weight, "REPLACE")
    for modifier in item.modifiers:
        added = obj.modifiers.new(modifier.name, modifier.kind)
        for key, value in modifier.settings.items():
            setattr(added, key, value)
    if item.lattice:
        obj.modifiers.new("Lattice", "LATTICE").object = bpy.data.objects[item.lattice]
    if item.subdivision:
        _subdivide(obj, item.subdivision)
    if item.loop:
        _show_loop(obj, item.loop)


def _mesh(name: str, shape: Shape, smooth: bool) -> bpy.types.Mesh:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(shape.vertices.tolist(), [], shape.faces)
    mesh.polygons.foreach_set("use_smooth", np.full(len(mesh.polygons), smooth))
    assert not mesh.validate(), f"{name}: invalid mesh"
    mesh.update()
    return mesh


def _subdivide(obj: bpy.types.Object, item: Subdivision) -> None:
    modifier = obj.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = modifier.render_levels = item.levels
    modifier.use_limit_surface = item.limit_surface
    modifier.boundary_smooth = "PRESERVE_CORNERS" if item.keep_corners else "ALL"
    if item.edge_creases:
        index = {tuple(sorted(edge.vertices)): edge.index for edge in obj.data.edges}
        crease = obj.data.attributes.new("crease_edge", "FLOAT", "EDGE").data
        for a, b, value in item.edge_creases:
            crease[index[min(a, b), max(a, b)]].value = value
    if item.vertex_creases:
        crease = obj.data.attributes.new("crease_vert", "FLOAT", "POINT").data
        for vertex, value in item.vertex_creases:
            crease[vertex].value = value


def _show_loop(cage: bpy.types.Object, levels: int) -> None:
    bpy.context.view_layer.objects.active = cage
    bpy.ops.stiv.loop_add(levels=levels)
    cage.stiv.loop.object.color = cage.color


def _material(item: Material) -> bpy.types.Material:
    known = bpy.data.materials.get(item.name)
    if known:
        return known
    material = bpy.data.materials.new(item.name)
    material.diffuse_color, material.roughness = item.color, item.roughness  # the colour that Workbench shows
    material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*item.color[:3], 1.0)
    shader.inputs["Alpha"].default_value = item.color[3]
    shader.inputs["Roughness"].default_value = item.roughness
    return material


def _add_view(view: View) -> None:
    scene = bpy.context.scene
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.data.lens = view.lens
    scene.camera = camera
    aim = Vector(view.target) - Vector(view.camera)
    _link(camera, Placement(view.camera, tuple(aim.to_track_quat("-Z", "Y").to_euler())))
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.data.angle = 3.0, 0.1
    _link(sun, Placement(rotation=(0.7, 0.15, 0.6)))
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.8, 0.86, 0.95, 1.0)
    scene.world.color = (0.9, 0.92, 0.95)
    _set_render(scene, view.size)


def _set_render(scene: bpy.types.Scene, size: tuple[int, int]) -> None:
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.filepath = "//"
    scene.render.image_settings.compression, scene.render.dither_intensity = 90, 0.0  # small pictures
    scene.view_settings.view_transform = "Standard"
    shading = scene.display.shading
    shading.light, shading.color_type = "STUDIO", "MATERIAL"
    shading.show_cavity, shading.cavity_type = True, "BOTH"
    shading.show_shadows, shading.shadow_intensity = True, 0.25
    shading.background_type = "WORLD"
    scene.display.render_aa = "16"
