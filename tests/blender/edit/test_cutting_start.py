# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected objects that cut each other at the start: they move as one, and stop as one."""

from itertools import pairwise
from typing import Any

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, matrices, meet, select, shift, snapshot, stretch, turn
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import stiv
from stiv.blender import BlenderEdit, EditSettings, Motion

KINDS = {
    "move": shift(-3, 1, -1.5),
    "rotate": turn(0.7, "Z", (1, 2, 3)),
    "scale": stretch(1.3, (1, 2, 3)),
}
SUPPRESSED = [HealthCheck.function_scoped_fixture]


def cluster(seed: int, count: int = 3) -> list[Any]:
    """Crates turned at random, each of which cuts the one before."""
    chance = np.random.default_rng(seed)
    crates = []
    for k in range(count):
        place = np.array((1.3 * k, 0, 0)) + chance.uniform(-0.3, 0.3, 3)
        crates.append(add_cube(f"Crate {k}", place, rotation_euler=chance.uniform(-3, 3, 3)))
    assert all(meet(a.name, b.name) for a, b in pairwise(crates))
    return crates


def begin(kind: str = "move", **changes: Any) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, EditSettings(**changes), kind)


@pytest.mark.parametrize("kind", KINDS)
@settings(suppress_health_check=SUPPRESSED, max_examples=8)
@given(st.integers(0, 2**32 - 1))
def test_objects_that_cut_each_other_reach_the_goal(kind: str, seed: int) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    crates = cluster(seed)
    select(*crates)
    before = matrices(crates)
    edit = begin(kind)
    result = edit.apply(KINDS[kind])
    assert edit.write().passed
    assert result.status == "reached" and result.rounds == 0
    assert matrices(crates) == pytest.approx(KINDS[kind] @ before, abs=1e-5)


@pytest.mark.parametrize("response", ["slide", "slide_and_turn"])
@pytest.mark.parametrize("seed", range(4))
def test_a_wall_stops_them_as_one(seed: int, response: str) -> None:
    crates = cluster(seed)
    add_grid("Wall", 4, 20.0, rotation_euler=(0, 1.2, 0.3), location=(-5, 0, 0))
    select(*crates)
    before = matrices(crates)
    edit = begin(object_response=response)
    assert edit.start_notes == ("Crate 0 and 2 more cut each other, move as one",)
    result = edit.apply(shift(-6, 1.5))
    assert edit.write().passed and result.status == "corrected"
    motions = matrices(crates) @ np.linalg.inv(before)
    assert motions == pytest.approx(np.repeat(motions[:1], 3, axis=0), abs=1e-5)
    assert not any(meet(crate.name, "Wall") for crate in crates)
    assert motions[0, 1, 3] > 0.5  # it slides along the wall


def test_one_on_the_floor_leaves_it_with_the_others_and_esc_restores_it() -> None:
    add_grid("Floor", 1, 8.0)
    crates = [add_cube("Lower", (0, 0, 1)), add_cube("Upper", (0.3, 0.2, 2.5), rotation_euler=(0.1, 0.2, 0.3))]
    select(*crates)
    before, start = snapshot(), matrices(crates)
    edit = begin()
    assert edit.start_notes == ("Lower and Upper cut each other, move as one",)
    assert edit.apply(shift(1.5, 0.5)).status in ("reached", "corrected")
    assert edit.write().passed
    assert matrices(crates) == pytest.approx(shift(1.5, 0.5) @ start, abs=1e-4)
    assert not meet("Lower", "Floor")
    edit.restore()
    assert snapshot() == before


def test_another_one_that_touches_slides_on() -> None:
    """The wall stops two that cut each other; the one that only stands on them continues."""
    lower, other, upper = add_cube("Lower"), add_cube("Other", (0.5, 0, 0.2), 0.5), add_cube("Upper", (0, 0, 2))
    add_cube("Wall", (-4, 0, -0.5))
    select(lower, other, upper)
    edit = begin()
    edit.apply(shift(-3))
    assert edit.write().passed
    assert lower.location.x == pytest.approx(-2, abs=0.02)
    assert other.location.x == pytest.approx(-1.5, abs=0.02)
    assert upper.location.x == pytest.approx(-3, abs=0.02)


def test_open_surfaces_in_the_same_place_move_as_one() -> None:
    sheets = [add_grid("One", 3), add_grid("Other", 3)]
    select(*sheets)
    for kind, motion in KINDS.items():
        before = matrices(sheets)
        edit = begin(kind)
        assert edit.apply(motion).status == "reached"
        assert edit.write().passed
        assert matrices(sheets) == pytest.approx(motion @ before, abs=1e-5)


def test_a_lamp_moves_along() -> None:
    crates = cluster(0)
    lamp = add("Lamp", bpy.data.lights.new("Lamp", "POINT"), (0, 0, 4))
    select(*crates, lamp)
    edit = begin()
    edit.apply(shift(1, 2, 3))
    assert edit.write().passed
    assert tuple(lamp.location) == pytest.approx((1, 2, 7), abs=1e-5)
    assert "move as one" in edit.start_notes[0]


def test_one_with_a_lock_stays_alone() -> None:
    crates = cluster(0, 2)
    crates[1].lock_location[2] = True
    select(*crates)
    edit = begin()
    assert len(edit.control_sets) == 2
    assert "may only part" in edit.start_notes[0]


def test_individual_origins_leave_each_alone() -> None:
    crates = cluster(0)
    select(*crates)
    bpy.context.scene.tool_settings.transform_pivot_point = "INDIVIDUAL_ORIGINS"
    assert len(begin("rotate").control_sets) == 3
    assert len(begin("move").control_sets) == 1


def test_a_scale_along_one_axis_needs_equal_rotations() -> None:
    crates = cluster(0)
    select(*crates)
    before = snapshot()
    edit = begin("scale")
    with pytest.raises(
        stiv.InputError, match=r'^Crate 1: moves with "Crate 0" but has another rotation; scale it alone$'
    ):
        edit.apply(stretch((1.5, 1, 1)))
    edit.restore()
    assert snapshot() == before
    for crate in crates:
        crate.rotation_euler = (0.1, 0.2, 0.3)
    bpy.context.view_layer.update()
    axes = np.array(crates[0].matrix_world)[:3, :3]
    longer = np.eye(4)
    longer[:3, :3] = axes @ np.diag((1.5, 1, 1)) @ axes.T
    start = matrices(crates)
    edit = begin("scale")
    assert edit.apply(longer).status == "reached"
    assert edit.write().passed
    assert matrices(crates) == pytest.approx(longer @ start, abs=1e-5)


def test_an_own_pivot_is_refused_where_the_tool_has_another() -> None:
    crates = cluster(0)
    select(*crates)
    edit = begin("rotate")
    with pytest.raises(stiv.InputError, match=r'^Crate 1: only moves together with "Crate 0"; choose another pivot$'):
        edit.drag(Motion(turn(0.3, "Z"), np.zeros(3), individual=True))


def test_collisions_may_be_off_at_the_start() -> None:
    crates = cluster(0)
    select(*crates)
    before = matrices(crates)
    edit = begin(interference=False)
    edit.drag(shift(1, 2, 3))
    edit.set_interference(True)
    edit.drag(shift(1, 2, 3))
    assert edit.write().passed
    assert matrices(crates) == pytest.approx(shift(1, 2, 3) @ before, abs=1e-5)
