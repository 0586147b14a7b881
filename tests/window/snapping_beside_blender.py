# SPDX-License-Identifier: GPL-3.0-or-later
"""Random snaps: the drag without collisions ends where Blender's own transform ends, in the same scene."""

from __future__ import annotations

import os
import random
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Any

import bmesh
import bpy
import mathutils
import numpy as np
import scenes
from simulation import Steps, Window

COUNT = int(os.environ.get("STIV_WINDOW_SNAPS", "10"))
FIRST = int(os.environ.get("STIV_WINDOW_FIRST_SNAP", "0"))
# For each unit of travel; a tenth of a pixel of the view is 1e-3. Blender computes in single precision, and where an
# axis nearly lies in the plane of a face, its error grows with the way to it.
TOLERANCE = 5e-3
ELEMENTS = (
    {"VERTEX"}, {"EDGE"}, {"EDGE_MIDPOINT"}, {"EDGE_PERPENDICULAR"}, {"FACE"}, {"VOLUME"}, {"GRID"}, {"INCREMENT"},
    {"VERTEX", "EDGE", "FACE"}, {"EDGE_MIDPOINT", "EDGE"}, {"VERTEX", "EDGE_MIDPOINT"}, {"VERTEX", "INCREMENT"},
    {"VERTEX", "FACE"}, {"EDGE", "EDGE_PERPENDICULAR", "VERTEX"}, {"FACE", "VOLUME"},
    {"FACE_PROJECT"}, {"FACE_NEAREST"},
)  # fmt: skip
BROKEN = {"VOLUME"} if bpy.app.version < (4, 4, 0) else set()  # Blender 4.3 aborts when it frees its layers
KEYS = {"move": ("G", "M"), "rotate": ("R", "R"), "scale": ("S", "E")}
LOCKS = ("", "", "", "", "X", "Y", "Z", "XX", "ZZ", "shift X", "shift Y", "shift Z", "shift ZZ")


@dataclass
class Case:
    """One random snap; `text` describes it."""

    seed: int
    kind: str
    mode: str
    lock: str
    elements: frozenset[str]
    pixel: tuple[int, int] = (0, 0)
    text: str = ""


def snaps_as_blender(window: Window) -> Steps:
    """Ten random snaps, or STIV_WINDOW_SNAPS from STIV_WINDOW_FIRST_SNAP; prints seed and difference of each."""
    restore = draw_quickly(window)
    try:
        differences = yield from compare(window)
        window.picture("snaps_as_blender")
    finally:
        restore()
    assert not differences, "\n".join(differences)


def compare(window: Window) -> Generator[float | None, None, list[str]]:
    """The snaps that differ."""
    differences = []
    for seed in range(FIRST, FIRST + COUNT):
        case = prepare(window, seed)
        yield from window.settle(2)
        aim(window, case)
        yield from window.rest_at(tuple(bpy.context.object.matrix_world.translation))
        # On the side of the target: beyond the pivot, Blender's scale mirrors.
        away = np.subtract(case.pixel, window.mouse) + 0.5
        window.move(*(round(at) for at in window.mouse + 70.0 * away / np.linalg.norm(away)))
        yield
        results, before = [], placed()
        for ours in (False, True):
            yield from begin(window, case, ours=ours)
            yield from follow(window, case)
            results.append(placed())
            window.key("ESC")
            yield from window.until(lambda: not window.handle.modal_operators, "the end of the transform")
            yield from window.settle(2)
        away, travel = (float(np.abs(results[0] - other).max()) for other in (results[1], before))
        print(f"snap {seed}: {case.text}: {away:.2e} of {travel:.3g}", flush=True)
        if away > TOLERANCE * max(1.0, travel):
            differences.append(f"seed {seed} ({case.text}): {away:.3g}")
    return differences


def draw_quickly(window: Window) -> Callable[[], None]:
    """Draw no overlays, gizmos and antialiasing, on which snapping does not depend; returns what restores them."""
    space, system = window.area.spaces.active, bpy.context.preferences.system
    settings = ((space.overlay, "show_overlays", False), (space, "show_gizmo", False), (system, "viewport_aa", "OFF"))
    before = [(holder, name, getattr(holder, name)) for holder, name, _ in settings]
    for holder, name, value in settings:
        setattr(holder, name, value)

    def restore() -> None:
        for holder, name, value in before:
            setattr(holder, name, value)

    return restore


def begin(window: Window, case: Case, *, ours: bool) -> Steps:
    """Start the transform of Blender, or that of the extension."""
    key = KEYS[case.kind][ours]
    window.key(key, **({"shift": True, "alt": True} if ours else {}))
    yield from window.until(lambda: bool(window.handle.modal_operators), "a running transform")


def follow(window: Window, case: Case) -> Steps:
    """Lock the axis, and go to the pixel."""
    start = window.mouse
    for part in (0.3, 1.0):
        window.move(*(round(a + (b - a) * part) for a, b in zip(start, case.pixel, strict=True)))
        yield
    shift = case.lock.startswith("shift")
    for key in case.lock.removeprefix("shift").strip():
        window.key(key, shift=shift)
        yield
    for _ in range(3):
        window.move(*case.pixel)
        yield
    yield from window.settle(3)
    window.mouse = start


def placed() -> np.ndarray:
    """Values that a transform changes: matrices of the selected objects, or vertices of the mesh in Edit Mode."""
    if bpy.context.mode == "OBJECT":
        return np.concatenate([np.array(obj.matrix_world) for obj in bpy.context.scene.objects if obj.select_get()])
    obj = bpy.context.object
    return np.array([list(obj.matrix_world @ vertex.co) for vertex in bmesh.from_edit_mesh(obj.data).verts])


def prepare(window: Window, seed: int) -> Case:
    """A random scene, view and settings."""
    rng = random.Random(seed)
    with window.override():
        scenes.clear()
        scene = bpy.context.scene
        scene.stiv.interference = False
        case = Case(
            seed,
            rng.choice(("move", "move", "move", "move", "rotate", "scale")),
            rng.choice(("OBJECT", "OBJECT", "EDIT")),
            rng.choice(LOCKS),
            frozenset(ELEMENTS[seed % len(ELEMENTS)] - BROKEN),
        )
        for index in range(4):
            add_target(rng, index)
        add_special(rng)
        movers = [add_mover(rng, "Mover"), *([add_mover(rng, "Other")] if rng.random() < 0.4 else [])]
        scenes.select_only(movers[0])
        for mover in movers:
            mover.select_set(True)
        if case.mode == "EDIT":
            bpy.ops.object.mode_set(mode="EDIT")
            select_some(rng)
        look(window, rng)
        choose(scene, rng, case)
        case.text += f"{case.kind} {case.mode} {'+'.join(sorted(case.elements))} lock {case.lock!r}"
    return case


def add_target(rng: random.Random, index: int) -> Any:
    """A random mesh with random proportions."""

    def build(content: bmesh.types.BMesh) -> None:
        shape = rng.randrange(4)
        if shape == 0:
            bmesh.ops.create_cube(content, size=1.0)
        elif shape == 1:
            bmesh.ops.create_icosphere(content, subdivisions=2, radius=0.7)
        elif shape == 2:
            bmesh.ops.create_grid(content, x_segments=3, y_segments=2, size=0.9)
        else:
            bmesh.ops.create_cone(content, segments=5, radius1=0.8, radius2=0.2, depth=1.1, cap_ends=True)

    place = tuple(rng.uniform(-2.5, 2.5) for _ in range(3))
    obj = scenes.add_mesh(f"Target{index}", build, place)
    obj.rotation_euler = [rng.uniform(-3, 3) for _ in range(3)]
    obj.scale = [rng.uniform(0.4, 1.6) for _ in range(3)]
    return obj


def add_mover(rng: random.Random, name: str) -> Any:
    """An object to move."""
    place = tuple(rng.uniform(-2.0, 2.0) for _ in range(3))
    obj = scenes.add_mesh(name, lambda content: bmesh.ops.create_cube(content, size=0.7), place)
    obj.rotation_euler = [rng.uniform(-3, 3) for _ in range(3)]
    return obj


def add_special(rng: random.Random) -> None:
    """An instance, a hidden object, one that cannot be selected, a wireframe, an empty, or a curve."""
    kind = rng.randrange(7)
    place = [rng.uniform(-2.0, 2.0) for _ in range(3)]
    if kind == 0:
        collection = bpy.data.collections.new("Source")
        mesh = bpy.data.meshes.new("Shared")
        content = bmesh.new()
        bmesh.ops.create_cube(content, size=0.8)
        content.to_mesh(mesh)
        content.free()
        collection.objects.link(bpy.data.objects.new("Inner", mesh))
        obj = bpy.data.objects.new("Instance", None)
        obj.instance_type, obj.instance_collection = "COLLECTION", collection
        bpy.context.collection.objects.link(obj)
    elif kind in (1, 2, 3):
        obj = add_target(rng, 9)
        obj.hide_viewport = kind == 1
        obj.hide_select = kind == 2
        obj.display_type = "WIRE" if kind == 3 else "TEXTURED"
    elif kind == 4:
        obj = bpy.data.objects.new("Empty", None)
        bpy.context.collection.objects.link(obj)
    else:
        data = bpy.data.curves.new("Curve", "CURVE")
        data.dimensions = "3D"
        spline = data.splines.new("BEZIER")
        spline.bezier_points.add(1)
        for point, x in zip(spline.bezier_points, (-0.6, 0.6), strict=True):
            point.co, point.handle_left, point.handle_right = (x, 0, 0), (x - 0.3, 0.3, 0), (x + 0.3, -0.3, 0)
        data.bevel_depth = 0.1 if kind == 5 else 0.0
        obj = bpy.data.objects.new("Curve", data)
        bpy.context.collection.objects.link(obj)
    obj.location = place


def select_some(rng: random.Random) -> None:
    """In Edit Mode: some vertices of each mesh."""
    for obj in bpy.context.objects_in_mode:
        content = bmesh.from_edit_mesh(obj.data)
        for vertex in content.verts:
            vertex.select_set(False)
        for vertex in rng.sample(sorted(content.verts, key=lambda vertex: vertex.index), rng.randrange(1, 4)):
            vertex.select_set(True)
        content.select_flush_mode()
        bmesh.update_edit_mesh(obj.data)


def look(window: Window, rng: random.Random) -> None:
    """A random view: perspective or parallel, also along an axis."""
    view = window.area.spaces.active.region_3d
    view.view_perspective = rng.choice(("PERSP", "PERSP", "ORTHO"))
    view.view_rotation = mathutils.Euler([rng.uniform(0.2, 1.4), 0.0, rng.uniform(-3, 3)]).to_quaternion()
    if view.view_perspective == "ORTHO" and rng.random() < 0.5:
        bpy.ops.view3d.view_axis(type=rng.choice(("TOP", "FRONT", "RIGHT")))
        view.view_perspective = "ORTHO"
    view.view_location, view.view_distance = (0.0, 0.0, 0.0), rng.uniform(9.0, 14.0)
    view.update()


def choose(scene: Any, rng: random.Random, case: Case) -> None:
    """Random settings of snapping, pivot and orientation."""
    tools = scene.tool_settings
    tools.use_snap = True
    tools.snap_elements = set(case.elements)
    sources = ("CLOSEST", "CLOSEST", "CENTER", "MEDIAN", "ACTIVE") if case.kind == "move" else ("CLOSEST",)
    tools.snap_target = rng.choice(sources)  # Blender turns by 60 degrees where the source is the pivot
    tools.use_snap_translate = tools.use_snap_rotate = tools.use_snap_scale = True
    tools.use_snap_backface_culling = rng.random() < 0.2
    tools.use_snap_selectable = rng.random() < 0.2
    tools.use_snap_peel_object = rng.random() < 0.5
    tools.use_snap_self = rng.random() < 0.8
    tools.use_snap_edit = rng.random() < 0.8
    tools.use_snap_nonedit = rng.random() < 0.85
    tools.use_snap_align_rotation = aligns(case)
    tools.transform_pivot_point = rng.choice(("MEDIAN_POINT", "MEDIAN_POINT", "ACTIVE_ELEMENT", "CURSOR"))
    scene.cursor.location = [rng.uniform(-1, 1) for _ in range(3)]
    scene.transform_orientation_slots[0].type = rng.choice(("GLOBAL", "GLOBAL", "LOCAL"))
    if (case.kind == "scale" and case.mode == "OBJECT") or case.elements & {"FACE_PROJECT", "FACE_NEAREST"}:
        case.lock = ""  # an object is scaled along its own axes; faces of its own would take it off the axis
    if len(bpy.context.selected_objects) > 1 and case.lock in ("XX", "ZZ", "shift ZZ"):
        case.lock = case.lock[:-1]  # several objects each along their own axes
    if len(bpy.context.selected_objects) > 1:
        scene.transform_orientation_slots[0].type = "GLOBAL"
    case.text = f"{tools.snap_target} {tools.transform_pivot_point} {scene.transform_orientation_slots[0].type} "
    for name in ("backface_culling", "selectable", "peel_object", "self", "edit", "nonedit"):
        case.text += name[0] if getattr(tools, f"use_snap_{name}") else "-"
    case.text += " aligned " if tools.use_snap_align_rotation else " "


def aligns(case: Case) -> bool:
    """Whether a case turns the objects onto the target; not where Blender and the extension differ on purpose."""
    differs = case.lock or case.elements & {"FACE_PROJECT", "FACE_NEAREST"}
    return not differs and case.mode == "OBJECT" and random.Random(case.seed + 2000000).random() < 0.5


def aim(window: Window, case: Case) -> None:
    """A pixel near a random element of a target."""
    rng = random.Random(case.seed + 1000000)
    view = window.area.spaces.active.region_3d
    case.text += " " + ("P" if view.is_perspective else "A" if view.is_orthographic_side_view else "O")
    names = [obj for obj in bpy.context.scene.objects if not obj.select_get() and obj.visible_get()]
    obj = rng.choice(names)
    place = obj.matrix_world.translation
    if obj.type == "MESH":
        mesh = obj.data
        polygon = rng.choice(list(mesh.polygons))
        corners = [mesh.vertices[index].co for index in polygon.vertices]
        weights = [rng.random() ** 3 for _ in corners]
        inside = np.average([list(corner) for corner in corners], axis=0, weights=weights)
        place = obj.matrix_world @ mathutils.Vector(inside)
    x, y = window.pixel(tuple(place))
    region = window.region
    x, y = x + rng.randint(-8, 8), y + rng.randint(-8, 8)
    case.pixel = (
        min(max(x, region.x + 60), region.x + region.width - 60),
        min(max(y, region.y + 60), region.y + region.height - 60),
    )


SNAPPING_BESIDE_BLENDER = {"snaps_as_blender": snaps_as_blender}
