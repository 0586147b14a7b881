# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigs and bones that cannot be posed are refused by name: without a surface, in cycles, locked or connected."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import numpy as np
import pytest
from building import evaluated, shift, turn
from test_posing import SETTINGS, SHOULDER, apply, box_below_hand

import stiv
from blend_fixtures.characters import select_bones
from stiv.blender import BlenderEdit, UnsupportedStackError
from stiv.blender.controls import control_reading
from stiv.blender.scene.driver_cycles import find_driver_cycle


def unskinned(rig: Any, body: Any) -> None:
    body.parent = None
    body.modifiers.clear()


def cyclic(rig: Any, body: Any) -> None:
    driver = rig.pose.bones["Arm.L"].driver_add("location", 0).driver
    variable = driver.variables.new()
    variable.type = "TRANSFORMS"
    variable.targets[0].id, variable.targets[0].bone_target = rig, "Forearm.L"


def add_driver(owner: Any, path: str, read_from: Any, read: str) -> None:
    """A driver that reads a property, or the transform of a bone ("bone NAME") or an object ("")."""
    driver = owner.driver_add(path)
    driver = driver[0].driver if isinstance(driver, list) else driver.driver
    variable = driver.variables.new()
    target = variable.targets[0]
    if read and not read.startswith("bone "):
        target.id_type = "KEY" if isinstance(read_from, bpy.types.Key) else "OBJECT"
        target.id, target.data_path = read_from, read
    else:
        variable.type = "TRANSFORMS"
        target.id, target.bone_target = read_from, read.removeprefix("bone ")
    driver.expression = variable.name


def cyclic_through_a_property(rig: Any, body: Any) -> None:
    """A bone from a property of the rig, that from a shape key, and that from the bone's child."""
    body.shape_key_add(name="Basis")
    key = body.shape_key_add(name="Fist")
    rig["grip"] = 0.0
    add_driver(key, "value", rig, "bone Forearm.L")
    add_driver(rig, '["grip"]', body.data.shape_keys, 'key_blocks["Fist"].value')
    add_driver(rig.pose.bones["Arm.L"], "location", rig, '["grip"]')


def cyclic_through_a_constraint(rig: Any, body: Any) -> None:
    """An object on the hand drives the influence of a constraint of the arm."""
    empty = bpy.data.objects.new("Empty", None)
    bpy.context.collection.objects.link(empty)
    empty.parent, empty.parent_type, empty.parent_bone = rig, "BONE", "Forearm.L"
    constraint = rig.pose.bones["Arm.L"].constraints.new("COPY_ROTATION")
    constraint.target, constraint.influence = bpy.data.objects["Box"], 0.0
    add_driver(constraint, "influence", empty, "")


def cyclic_elsewhere(rig: Any, body: Any) -> None:
    """Two properties of another object drive each other, and one of them a bone."""
    box = bpy.data.objects["Box"]
    box["one"] = box["two"] = 0.0
    add_driver(box, '["one"]', box, '["two"]')
    add_driver(box, '["two"]', box, '["one"]')
    add_driver(rig.pose.bones["Head"], "location", box, '["one"]')


def test_drivers_without_a_cycle_are_followed() -> None:
    """Raw channels of a bone differ from its transform, and a property may drive several bones."""
    rig, _, _ = box_below_hand()
    box = bpy.data.objects["Box"]
    rig["curl"] = box["level"] = 0.0
    add_driver(rig, '["curl"]', rig, 'pose.bones["Arm.L"].location[0]')
    add_driver(rig.pose.bones["Forearm.L"], "scale", rig, '["curl"]')
    add_driver(rig.pose.bones["Arm.L"], "location", box, "")
    add_driver(box, '["level"]', rig, "bone Head")
    assert find_driver_cycle(rig) == ("", "")


def at_rest(rig: Any, body: Any) -> None:
    rig.data.pose_position = "REST"


def nothing(rig: Any, body: Any) -> None:
    select_bones(rig)


def locked(rig: Any, body: Any) -> None:
    rig.pose.bones["Arm.L"].lock_rotation = (True, True, True)
    rig.pose.bones["Arm.L"].lock_rotations_4d = False


@pytest.mark.parametrize(
    ("prepare", "message"),
    [
        (unskinned, "Rig: it deforms no visible mesh; parent one to it"),
        (cyclic, r"Rig: a driver of Arm.L depends on itself; remove it"),
        (cyclic_through_a_property, r"a driver of .* depends on itself; remove it"),
        (cyclic_through_a_constraint, r"Rig: a driver of Arm.L depends on itself; remove it"),
        (cyclic_elsewhere, r'Box: a driver of \["\w+"\] depends on itself; remove it'),
        (at_rest, "Rig: it shows its rest position; choose Pose Position"),
        (nothing, "no bone is selected; select one"),
        (locked, "Rig: the rotation of Arm.L is locked; unlock it"),
    ],
)
def test_what_cannot_be_posed_is_refused_by_name(prepare: Callable[[Any, Any], None], message: str) -> None:
    rig, body, _ = box_below_hand()
    prepare(rig, body)
    before = evaluated(body)
    with pytest.raises(stiv.InputError, match=message):
        apply("rotate", turn(0.5, "Y", SHOULDER))
    assert np.array_equal(evaluated(body), before)


def test_connected_bones_cannot_move() -> None:
    rig, _, _ = box_below_hand()
    select_bones(rig, "Forearm.L")
    with pytest.raises(stiv.InputError, match=r"Rig: Forearm\.L is connected to its parent; rotate it"):
        apply("move", shift(z=-0.1))


def test_a_linked_rig_without_an_override_is_refused(tmp_path: Any) -> None:
    rig, _, _ = box_below_hand()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "character.blend"))
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(str(tmp_path / "character.blend"), link=True) as (source, wanted):
        wanted.objects = source.objects
    for ob in wanted.objects:
        bpy.context.scene.collection.objects.link(ob)
    rig = bpy.data.objects["Rig"]
    bpy.context.view_layer.objects.active = rig
    with pytest.raises(stiv.InputError, match="Rig: it is linked; make a library override"):
        stiv.blender.controls.bone_set.check_rig(rig)


def test_a_pose_that_a_copy_shows_differently_is_refused_without_applying_its_modifier(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Blender evaluates some rigs with several constraints on one bone in one of two ways, at random."""
    box_below_hand()
    monkeypatch.setattr(control_reading, "evaluation_tolerance", lambda points: -1.0)
    with pytest.raises(stiv.InputError, match="its pose cannot be followed") as refused:
        BlenderEdit.begin(bpy.context, SETTINGS, "rotate")
    assert not isinstance(refused.value, UnsupportedStackError)
