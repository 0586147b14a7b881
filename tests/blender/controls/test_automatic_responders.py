# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that yield without a role of their own."""

from typing import Any

import bpy
import pytest
from building import add, add_cube, add_grid, add_lattice, add_modifier, edit_mode, evaluated, select, shift, snapshot

import stiv
from stiv.blender import BlenderEdit, EditSettings, check_scene


def begin(responders: str = "unselected", **settings: Any) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, EditSettings(responders=responders, **settings), "move")


def roles(edit: BlenderEdit) -> dict[str, str]:
    return {each.name: each.role for each in edit.summary.participants}


def test_a_row_of_objects_is_pushed_along() -> None:
    pusher = add_cube("Pusher", size=0.5)
    row = [add_cube(f"Block {k}", (1.2 * (k + 1), 0.1 * k, 0), 0.5) for k in range(3)]
    select(pusher)
    start = snapshot()
    edit = begin()
    assert roles(edit) == dict.fromkeys(["Pusher", "Block 0", "Block 1", "Block 2"], "rigid")
    assert snapshot() == start
    edit.apply(shift(1.5))
    assert edit.write().passed
    assert pusher.location.x == pytest.approx(1.5, abs=1e-6)
    assert all(ob.location.x > 1.2 * (k + 1) + 0.3 for k, ob in enumerate(row))
    assert check_scene(bpy.context).pairs == ()
    edit.restore()
    assert snapshot() == start


def test_all_lets_both_sides_yield() -> None:
    pusher, other = add_cube("Pusher", size=0.5), add_cube("Other", (1.2, 0, 0), 0.5)
    select(pusher)
    edit = begin("all")
    edit.apply(shift(1.0))
    assert edit.write().passed
    assert 0.2 < pusher.location.x < 0.95
    assert other.location.x > 1.25
    assert check_scene(bpy.context).pairs == ()


def test_an_obstacle_never_moves() -> None:
    pusher, other = add_cube("Pusher", size=0.5), add_cube("Other", (1.2, 0, 0), 0.5)
    select(pusher)
    place = tuple(other.location)
    for responders in ("unselected", "all"):
        edit = begin(responders, roles={"Other": "obstacle"})
        result = edit.apply(shift(2.0))
        assert edit.write().passed
        assert tuple(other.location) == place
        assert check_scene(bpy.context).pairs == ()
        if responders == "unselected":
            assert result.status == "blocked"
            assert "Other" in result.blocking
        edit.restore()


def test_objects_yield_by_their_own_deformation() -> None:
    pusher, sheet = add_cube("Pusher", size=0.5), add_grid("Sheet", 6, location=(0, 0, 0.7))
    select(pusher)
    assert roles(begin("selected", deformations={"Sheet": "vertices"}))["Sheet"] == "obstacle"
    edit = begin(deformations={"Sheet": "vertices"})
    assert roles(edit)["Sheet"] == "cage"
    edit.apply(shift(z=0.5))
    assert edit.write().passed
    assert tuple(sheet.location) == pytest.approx((0, 0, 0.7))
    z = evaluated(sheet)[:, 2]
    assert z.max() > 0.95 and z.min() < 0.9
    assert check_scene(bpy.context).pairs == ()


def test_objects_that_cannot_move_are_obstacles() -> None:
    pusher = add_cube("Pusher", size=0.5)
    held = add_cube("Held", (0, 3, 0), 0.5)
    held.constraints.new("LIMIT_LOCATION")
    mirrored = add_cube("Mirrored", (0, 6, 0), 0.5)
    add_modifier(mirrored, "MIRROR", mirror_object=held)
    bent = add_cube("Bent", (0, 9, 0), 0.5)
    add_modifier(bent, "LATTICE", object=add_lattice("Lattice", (2, 2, 2), (0, 9, 0)))
    animated = add_cube("Animated", (0, 12, 0), 0.5)
    animated.keyframe_insert("location")
    parent = add_cube("Parent", (0, 15, 0), 0.5)
    child = add_cube("A child", (0, 2, 0), 0.5, parent=parent)
    part = add_cube("Part", (0, 20, 0), 0.5)
    collection = bpy.data.collections.new("Shown twice")
    collection.objects.link(part)
    add("Instancer", None, (0, 24, 0), instance_type="COLLECTION", instance_collection=collection)
    carrier = add_cube("Carrier", (0, -4, 0), 0.5)
    pusher.parent = carrier
    pusher.matrix_parent_inverse = carrier.matrix_world.inverted()
    select(pusher)
    edit = begin()
    found = roles(edit)
    rigid = {name for name, role in found.items() if role == "rigid"}
    assert rigid == {"Pusher", "Parent", "A child"}
    del child


def test_metaballs_are_obstacles() -> None:
    data = bpy.data.metaballs.new("Ball")
    data.elements.new()
    ball = add("Ball", data, (2.5, 0, 0))
    pusher = add_cube("Pusher", (-1, 0, 0), 0.5)
    select(pusher)
    edit = begin("all")
    assert roles(edit)["Ball"] == "obstacle"
    edit.apply(shift(x=3))
    assert edit.write().passed
    assert ball.location.x == 2.5


def test_in_edit_mode_other_objects_stay() -> None:
    """Blender's undo of Edit Mode would not take them back."""
    sheet = add_grid("Sheet", 4)
    add_cube("Other", (0, 0, 1.2), 0.5)
    edit_mode(sheet)
    bpy.ops.mesh.select_all(action="SELECT")
    assert roles(begin("all", deformations={"Other": "vertices"}))["Other"] == "obstacle"


def test_nothing_selected_is_refused_as_before() -> None:
    add_cube("Other")
    select()
    with pytest.raises(stiv.InputError, match="nothing movable is selected"):
        begin("all")
