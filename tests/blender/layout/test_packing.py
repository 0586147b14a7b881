# SPDX-License-Identifier: GPL-3.0-or-later
"""Fit into: everything packed is inside by winding numbers and intersects nothing; the rest is named."""

import bpy
import numpy as np
import pytest
from building import add, add_bowl, add_cube, mesh, select

import stiv
from stiv.blender import EditSettings, FitSettings, check_scene, fit_into, nearest_pair

H = 0.005
EDIT = EditSettings(separation=H)


def crate(size: float = 2.0, wall: float = 0.2) -> bpy.types.Object:
    """A box with thick walls, open above: a closed mesh around its material."""
    outer = [(x, y, z) for z in (0, size) for x, y in ((0, 0), (size, 0), (size, size), (0, size))]
    low, high = wall, size - wall
    inner = [(x, y, z) for z in (wall, size) for x, y in ((low, low), (high, low), (high, high), (low, high))]
    sides = [(k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4) for k in range(4)]
    faces = [(3, 2, 1, 0), *sides]
    faces += [tuple(8 + each for each in face[::-1]) for face in sides] + [(8, 9, 10, 11)]
    faces += [(4 + k, 4 + (k + 1) % 4, 12 + (k + 1) % 4, 12 + k) for k in range(4)]
    return add("Crate", mesh("Crate", outer + inner, faces))


def positions(ob: bpy.types.Object) -> np.ndarray:
    return np.array([ob.matrix_world @ vertex.co for vertex in ob.data.vertices])


def winding(points: np.ndarray, ob: bpy.types.Object) -> np.ndarray:
    """The sum of signed solid angles, by l'Huilier's formula of spherical excess."""
    ob.data.calc_loop_triangles()
    corners = positions(ob)[[tuple(each.vertices) for each in ob.data.loop_triangles]]
    found = []
    for point in points:
        unit = corners - point
        unit = unit / np.linalg.norm(unit, axis=2)[:, :, None]
        sides = [np.arccos(np.clip((unit[:, k - 2] * unit[:, k - 1]).sum(axis=1), -1, 1)) for k in range(3)]
        half = sum(sides) / 2
        root = np.tan(half / 2) * np.prod([np.tan(np.maximum(half - side, 0) / 2) for side in sides], axis=0)
        sign = np.sign(np.linalg.det(unit))
        found.append(float((sign * 4 * np.arctan(np.sqrt(np.maximum(root, 0)))).sum() / (4 * np.pi)))
    return np.array(found)


def add_parts(count: int, size: float, seed: int = 0) -> list[bpy.types.Object]:
    rng = np.random.default_rng(seed)
    return [
        add_cube(f"Part {k}", (8 + 2 * k, 0, 0), size * rng.uniform(0.6, 1), scale=rng.uniform(0.7, 1, 3))
        for k in range(count)
    ]


@pytest.mark.shared
@pytest.mark.parametrize(("rim", "thickness", "tilt"), [(0.05, 0.0, 0.2), (0.05, 0.2, 0.0), (1.2, 0.2, 0.0)])
def test_bowls_and_jars_are_filled_from_above(rim: float, thickness: float, tilt: float) -> None:
    """A thin bowl that is tilted, a thick one, and a jar; each part is between its wall, by Blender's ray casts."""
    bowl, parts = add_bowl(2.0, rim), add_parts(6, 0.3)
    bowl.rotation_euler.x = tilt
    if thickness:
        bowl.modifiers.new("Solidify", "SOLIDIFY").thickness = thickness
    select(bowl, *parts)
    report = fit_into(bpy.context, FitSettings(EDIT, seed=1))
    assert report.status == "done" and not report.left
    bpy.context.view_layer.update()
    shown = bowl.evaluated_get(bpy.context.evaluated_depsgraph_get())
    for part in parts:
        place = bowl.matrix_world.inverted() @ part.location
        around = [(np.cos(angle), np.sin(angle), 0.0) for angle in np.linspace(0, 6, 16)]
        hits = [shown.ray_cast(place, direction) for direction in (*around, (0, 0, -1))]
        assert all(hit[0] for hit in hits), part.name
        assert all(
            hit[1].length < 2.001 and (hit[1] - place).dot(hit[2]) * (-1 if thickness else 1) > 0 for hit in hits
        )
        assert positions(part)[:, 2].max() <= positions(bowl)[:, 2].max()
    assert check_scene(bpy.context).pairs == ()


def test_an_open_crate_is_filled_from_above() -> None:
    box, parts = crate(), add_parts(6, 0.3)
    select(box, *parts)
    report = fit_into(bpy.context, FitSettings(EDIT, seed=1))
    bpy.context.view_layer.update()
    assert sorted(report.changed) == [f"Part {k}" for k in range(6)] and report.scale == 1
    for part in parts:
        points = positions(part)
        assert points.min() > 0.2 and points[:, :2].max() < 1.8 and points[:, 2].max() <= 2
    assert not check_scene(bpy.context).pairs and nearest_pair(bpy.context).distance >= H * (1 - 1e-3)


def test_everything_is_inside_a_closed_mesh() -> None:
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=2)
    ball, parts = bpy.context.object, add_parts(5, 0.4)
    select(ball, *parts)
    report = fit_into(bpy.context, FitSettings(EDIT))
    bpy.context.view_layer.update()
    assert len(report.changed) == 5 and not check_scene(bpy.context).pairs
    for part in parts:
        assert winding(positions(part), ball) == pytest.approx(np.ones(8), abs=1e-3)


@pytest.mark.shared
def test_the_rest_stays_and_is_named_unless_it_may_shrink() -> None:
    box, parts = crate(1.0, 0.1), add_parts(6, 0.3)
    starts = {part.name: tuple(part.location) for part in parts}
    select(box, *parts)
    report = fit_into(bpy.context, FitSettings(EDIT))
    names = {name for name, reason in report.left if reason == "no room"}
    assert names and names | set(report.changed) == set(starts) and report.asked == 6
    assert all(tuple(bpy.data.objects[name].location) == starts[name] for name in names)
    sizes = [tuple(part.scale) for part in parts]
    report = fit_into(bpy.context, FitSettings(EDIT, scale=True))
    bpy.context.view_layer.update()
    assert len(report.changed) == 6 and 0 < report.scale < 1 and not check_scene(bpy.context).pairs
    for part, size in zip(parts, sizes, strict=True):
        assert tuple(part.scale) == pytest.approx(tuple(report.scale * np.array(size)), rel=1e-5)
        assert positions(part).min() > 0.1 and positions(part)[:, 2].max() <= 1


def test_bad_input_is_refused_by_name() -> None:
    box, parts = crate(), add_parts(1, 0.3)
    select(parts[0])
    with pytest.raises(stiv.InputError, match="select the objects to pack"):
        fit_into(bpy.context)
    sheet = add("Sheet", mesh("Sheet", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]))
    select(sheet, *parts)
    with pytest.raises(stiv.InputError, match="Sheet: is not closed"):
        fit_into(bpy.context, FitSettings(container="inside"))
    parts[0].lock_scale[1] = True
    select(box, *parts)
    with pytest.raises(stiv.InputError, match="Part 0: its scale is locked"):
        fit_into(bpy.context, FitSettings(scale=True))
