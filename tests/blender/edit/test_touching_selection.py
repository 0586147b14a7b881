# SPDX-License-Identifier: GPL-3.0-or-later
"""Selected objects that only touch each other: they move as one, whatever rounding makes of their contact."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import (
    add_cube,
    add_grid,
    add_modifier,
    deepest,
    edit_mode,
    matrices,
    select,
    shift,
    snapshot,
    stretch,
    turn,
)
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from stiv.blender import BlenderEdit, EditSettings

DEEPEST = 64  # roundings of the largest coordinate
KINDS = {
    "move": shift(-3, 1, -1.5),
    "rotate": turn(0.7, "Z", (1, 2, 3)),
    "scale": stretch(1.3, (1, 2, 3)),
}
SUPPRESSED = [HealthCheck.function_scoped_fixture]


def tower(seed: int, count: int = 3) -> tuple[list[Any], np.ndarray]:
    """Crates on each other, turned and placed at random, so that rounding decides which ones intersect. Also returns
    their axes as columns.
    """
    chance = np.random.default_rng(seed)
    angles, place = chance.uniform(-3, 3, 3), chance.uniform(-5, 5, 3)
    crates = [add_cube("Crate 0", place, rotation_euler=angles)]
    across = np.array(crates[0].matrix_world)[:3, :3]
    for k in range(1, count):
        beside = (*chance.uniform(-0.9, 0.9, 2), 2 * k)
        crates.append(add_cube(f"Crate {k}", place + across @ beside, rotation_euler=angles))
    return crates, across


def begin(kind: str = "move") -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, EditSettings(), kind)


@pytest.mark.parametrize("kind", KINDS)
@settings(suppress_health_check=SUPPRESSED, max_examples=8)
@given(st.integers(0, 2**32 - 1))
def test_crates_on_each_other_reach_the_goal(kind: str, seed: int) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    crates, _ = tower(seed)
    select(*crates)
    before = matrices(crates)
    edit = begin(kind)
    result = edit.apply(KINDS[kind])
    assert edit.write().passed
    assert result.status == "reached" and result.rounds == 0
    assert matrices(crates) == pytest.approx(KINDS[kind] @ before, abs=1e-5)
    assert deepest() < DEEPEST


@pytest.mark.parametrize("seed", range(4))
def test_a_wall_stops_one_and_the_others_slide_on(seed: int) -> None:
    crates, across = tower(seed)
    wall = add_cube("Wall", np.array(crates[0].location) + across @ (-4, 0, -0.5))
    wall.rotation_euler = crates[0].rotation_euler  # lower than the first crate
    select(*crates)
    start = np.array([ob.location for ob in crates])
    edit = begin()
    result = edit.apply(shift(*(across @ (-3, 1, 0))))
    assert edit.write().passed and result.status == "corrected"
    moved = (np.array([ob.location for ob in crates]) - start) @ across
    assert moved[0, 0] == pytest.approx(-2, abs=0.02)
    assert (moved[1:, 0] < -2.5).all()  # an edge of another crate may hold one back on the way to -3
    assert deepest() < DEEPEST


def test_a_stack_on_a_floor_leaves_it_as_one_and_esc_restores_it() -> None:
    add_grid("Floor", 1, 8.0)
    crates = [add_cube("Lower", (0, 0, 1)), add_cube("Upper", (0.3, 0.2, 3))]
    select(*crates)
    before = snapshot()
    edit = begin()
    assert edit.apply(shift(1.5, 0.5)).status in ("reached", "corrected")
    assert edit.write().passed
    ends = np.array([ob.location for ob in crates])
    assert ends == pytest.approx(np.array([(1.5, 0.5, 1), (1.8, 0.7, 3)]), abs=1e-4)
    edit.restore()
    assert snapshot() == before


def test_a_floor_moves_with_the_cube_on_it() -> None:
    floor, cube = add_grid("Floor", 1, 8.0), add_cube("Cube", (0, 0, 1))
    select(floor, cube)
    for kind, motion in KINDS.items():
        before = matrices([floor, cube])
        edit = begin(kind)
        assert edit.apply(motion).status == "reached"
        assert edit.write().passed
        assert matrices([floor, cube]) == pytest.approx(motion @ before, abs=1e-5)


def test_faces_of_modifiers_touch_too() -> None:
    crates, _ = tower(3)
    for crate in crates:
        add_modifier(crate, "SUBSURF", subdivision_type="SIMPLE", levels=2, render_levels=2)
    select(*crates)
    before = matrices(crates)
    edit = begin("rotate")
    assert edit.apply(KINDS["rotate"]).status == "reached"
    assert edit.write().passed
    assert matrices(crates) == pytest.approx(KINDS["rotate"] @ before, abs=1e-5)


def test_cages_that_touch_move_and_turn_together_in_edit_mode() -> None:
    for kind in ("move", "rotate"):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        crates, _ = tower(1, 2)
        edit_mode(*crates)
        edit = begin(kind)
        assert edit.apply(KINDS[kind]).status == "reached"
        assert edit.write().passed
        assert deepest() < DEEPEST
        bpy.ops.object.mode_set(mode="OBJECT")


def test_the_next_edit_examines_the_contact_again() -> None:
    """Crates that an edit has parted are guarded by the next one."""
    lower, upper = add_cube("Lower"), add_cube("Upper", (0, 0, 2))
    add_cube("Wall", (0, -4, 0))
    select(lower, upper)
    edit = begin()
    edit.apply(shift(0, -3))  # the wall stops the lower one
    assert edit.write().passed
    edit.finish()
    select(upper)
    edit = begin()
    edit.apply(shift(0, 0, -3))
    assert edit.write().passed
    assert deepest() == 0
