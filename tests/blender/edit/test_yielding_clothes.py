# SPDX-License-Identifier: GPL-3.0-or-later
"""Clothes yield by their cage, handles or lattice, while the body follows its bones exactly."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import mathutils
import numpy as np
import pytest
from building import add_cube, evaluated, turn
from test_posing import SHOULDER, apply, intersecting

from blend_fixtures.characters import make_character, select_bones
from stiv import InputError
from stiv.blender import AcceptedScene, BlenderEdit, EditSettings, Handles, Motion, guard_result

GOAL = 20.0  # degrees by which the arm is lowered


def add_mesh(name: str, points: Any, faces: Any) -> Any:
    data = bpy.data.meshes.new(name)
    data.from_pydata(np.asarray(points).tolist(), [], np.asarray(faces).tolist())
    ob = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(ob)
    return ob


def add_sheet(height: float, half: float = 0.5, count: int = 12) -> Any:
    """A cloth below the left arm, in x 0.8 to 1.8."""
    x, y = np.meshgrid(np.linspace(0.8, 1.8, count), np.linspace(-half, half, count), indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), np.full(x.size, height)], axis=1)
    number = np.arange(count * count).reshape(count, count)
    quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
    return add_mesh("Cloth", points, quads)


def add_sleeve(rig: Any, radius: float = 0.22, around: int = 14, along: int = 9) -> Any:
    """An open tube around the left forearm, which follows the arm by an Armature modifier."""
    angle = 2 * np.pi * np.arange(around) / around
    ring = np.stack([np.zeros(around), radius * np.cos(angle), 1.35 + radius * np.sin(angle)], axis=1)
    points = np.concatenate([ring + (x, 0, 0) for x in np.linspace(1.05, 1.45, along)])
    number = np.arange(around * along).reshape(along, around)
    after = np.roll(number, -1, axis=1)
    quads = np.stack([number[:-1], number[1:], after[1:], after[:-1]], axis=-1).reshape(-1, 4)
    sleeve = add_mesh("Cloth", points, quads)
    sleeve.vertex_groups.new(name="Forearm.L").add(list(range(len(points))), 1.0, "REPLACE")
    sleeve.modifiers.new("Armature", "ARMATURE").object = rig
    return sleeve


@pytest.fixture
def rig() -> Any:
    rig, _ = make_character(0.1)
    select_bones(rig, "Arm.L")
    return rig


def lower(**settings: Any) -> tuple[Any, Any, Any]:
    chosen = EditSettings(
        separation=0.01, **{"responders": "unselected", "deformations": {"Cloth": "vertices"}} | settings
    )
    return apply("rotate", turn(np.radians(GOAL), "Y", SHOULDER), chosen)


def angle(rig: Any) -> float:
    return float(np.degrees(rig.pose.bones["Arm.L"].rotation_quaternion.angle))


def expect_yielded(rig: Any, cloth: Any, before: np.ndarray, others: tuple[str, ...]) -> None:
    """The arm is at its goal, and the cloth has moved out of its way."""
    assert angle(rig) == pytest.approx(GOAL, abs=1e-3)
    assert np.abs(evaluated(cloth) - before).max() > 0.03
    for name in others:
        assert intersecting(cloth, bpy.data.objects[name]) == 0, name


def test_a_cloth_on_a_cage_yields_to_an_arm(rig: Any) -> None:
    cloth = add_sheet(1.15)
    before = evaluated(cloth)
    blocked, _, edit = lower(responders="selected", deformations={})
    assert blocked.status == "corrected" and angle(rig) < 10
    edit.restore()
    result, report, _ = lower()
    assert result.status == "corrected" and report.passed
    expect_yielded(rig, cloth, before, ("Body",))


@pytest.mark.shared
@pytest.mark.parametrize("modifier", ["", "SUBSURF", "SOLIDIFY"])
def test_a_skinned_sleeve_yields_to_a_box(rig: Any, modifier: str) -> None:
    """The sleeve follows the arm by Blender's Armature modifier, and the box dents it."""
    sleeve = add_sleeve(rig)
    if modifier:
        added = sleeve.modifiers.new(modifier.title(), modifier)
        if modifier == "SOLIDIFY":
            added.thickness = 0.01
    add_cube("Box", (1.3, 0, 0.45), 0.42)
    select_bones(rig, "Arm.L")
    followed = turn(np.radians(GOAL), "Y", SHOULDER)
    before = evaluated(sleeve) @ followed[:3, :3].T + followed[:3, 3]
    _, report, edit = lower()
    assert report.passed, report
    expect_yielded(rig, sleeve, before, ("Box", "Body"))
    edit.restore()
    assert angle(rig) == 0


def test_a_lattice_yields(rig: Any) -> None:
    cloth = add_sheet(1.15)
    before = evaluated(cloth)
    lattice = bpy.data.objects.new("Lattice", bpy.data.lattices.new("Lattice"))
    lattice.data.points_u, lattice.data.points_v, lattice.data.points_w = 5, 4, 2
    lattice.location, lattice.scale = (1.3, 0, 1.15), (1.1, 1.1, 0.4)
    bpy.context.scene.collection.objects.link(lattice)
    cloth.modifiers.new("Lattice", "LATTICE").object = lattice
    bpy.context.view_layer.update()
    _, report, _ = lower(deformations={"Cloth": "lattice"})
    assert report.passed
    expect_yielded(rig, cloth, before, ("Body",))
    assert any(np.abs(np.array(p.co_deform) - p.co).max() > 0.01 for p in lattice.data.points)


@pytest.mark.shared
@pytest.mark.parametrize("kind", ["laplacian", "arap"])
def test_soft_handles_yield(rig: Any, kind: str) -> None:
    cloth = add_sheet(1.15)
    before = evaluated(cloth)
    inside = [k for k, v in enumerate(cloth.data.vertices) if abs(v.co.y) < 0.3 and 1.1 < v.co.x < 1.7]
    cloth.vertex_groups.new(name="Grip").add(inside[::3], 1.0, "REPLACE")
    _, report, _ = lower(deformations={"Cloth": kind}, handles={"Cloth": Handles(groups=("Grip",))})
    assert report.passed
    expect_yielded(rig, cloth, before, ("Body",))


def test_both_sides_share_the_way(rig: Any) -> None:
    cloth = add_sheet(1.15)
    _, report, _ = lower(responders="all")
    assert report.passed and 3 < angle(rig) < GOAL and intersecting(cloth, bpy.data.objects["Body"]) == 0


def test_a_cloth_with_an_obstacle_behind_it_stops_the_arm(rig: Any) -> None:
    cloth = add_sheet(1.15)
    add_cube("Box", (1.3, 0, 0.7), 0.4)
    select_bones(rig, "Arm.L")
    _, report, _ = lower()
    assert report.passed and angle(rig) < GOAL - 1
    assert intersecting(cloth, bpy.data.objects["Body"]) == intersecting(cloth, bpy.data.objects["Box"]) == 0


@pytest.mark.parametrize(
    ("prepare", "message"),
    [
        (lambda cloth: cloth.modifiers.new("Bevel", "REMESH"), "Cloth: Remesh"),
        (lambda cloth: None, "Cloth: .*handle"),
    ],
)
def test_clothes_that_cannot_yield_are_refused(rig: Any, prepare: Callable[[Any], Any], message: str) -> None:
    cloth = add_sheet(1.15)
    prepare(cloth)
    bpy.context.view_layer.update()
    with pytest.raises(InputError, match=message):
        lower(deformations={"Cloth": "vertices" if "Remesh" in message else "arap"})
    assert angle(rig) == 0


def test_a_drag_and_the_guard_let_clothes_yield(rig: Any) -> None:
    """A drag that leaves out far obstacles, with little time for each call; then a pose that another tool sets."""
    cloth = add_sheet(1.15)
    add_cube("Far", (40, 0, 0))
    select_bones(rig, "Arm.L")
    before = evaluated(cloth)
    settings = EditSettings(separation=0.01, responders="unselected", deformations={"Cloth": "vertices"})
    edit = BlenderEdit.begin(bpy.context, settings, "rotate")
    for number in range(1, 41):
        edit.drag(Motion(turn(np.radians(GOAL * number / 40), "Y", SHOULDER), np.array(SHOULDER)), time_budget=0.04)
    edit.settle()
    assert edit.write().passed
    expect_yielded(rig, cloth, before, ("Body",))
    edit.restore()
    accepted = AcceptedScene.read(bpy.context)
    axis = rig.data.bones["Arm.L"].matrix_local.to_3x3().inverted() @ mathutils.Vector((0, 1, 0))
    rig.pose.bones["Arm.L"].rotation_quaternion = mathutils.Quaternion(axis, np.radians(GOAL))
    outcome = guard_result(bpy.context, settings, accepted)
    assert outcome.wrote and outcome.reason == ""
    expect_yielded(rig, cloth, before, ("Body",))
