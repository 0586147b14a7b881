# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard and the undo history: one step for a tool and its correction."""

from collections.abc import Iterator
from typing import Any

import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

from guarding import FURTHEST, box, expect_free, look, move, names_of_steps, watched_scene  # noqa: E402

from stiv_addon.guard import undo_steps, watcher  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture(autouse=True)
def scene() -> Iterator[None]:
    yield from watched_scene()


def test_the_corrected_state_is_in_the_stack_also_with_the_guard_off() -> None:
    move(7.0)
    look()
    corrected = box().location.x
    bpy.ops.ed.undo()
    bpy.context.scene.stiv.live_guard = False
    bpy.ops.ed.redo()
    assert box().location.x == corrected


def test_a_script_is_corrected_in_a_step_of_its_own() -> None:
    before = names_of_steps()
    box().location.x = 2.4
    bpy.context.view_layer.update()
    look()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)
    assert names_of_steps() == [*before, watcher.STEP_NAME]
    bpy.ops.ed.undo()
    look()
    assert box().location.x == 0.0


def test_an_uncorrected_state_restored_by_undo_is_corrected_without_an_undo_step() -> None:
    watcher._watch.working = True  # as while the guard is off, with its switch on
    move(2.4)
    move(1.0)
    watcher._watch.working = False
    bpy.ops.ed.undo()
    look()
    expect_free()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)
    assert names_of_steps() == ["start", "Move", "Move"]


def test_undo_and_redo_leave_the_switches_as_they_are() -> None:
    settings = bpy.context.scene.stiv
    settings.live_guard = False
    bpy.ops.ed.undo_push(message="off")
    settings.live_transforms = True
    bpy.ops.ed.undo_push(message="on")
    move(1.0)
    look()
    for _ in range(2):
        bpy.ops.ed.undo()
    settings = bpy.context.scene.stiv
    assert settings.live_transforms and settings.live_guard
    move(7.0)
    look()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)
    settings.live_transforms = False
    bpy.ops.ed.undo()
    assert not bpy.context.scene.stiv.live_transforms and not bpy.context.scene.stiv.live_guard


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("[*  ]   2 {0x1} type='Global Undo', name='Move'\n", (2, "0x1", "Move")),
        ("[    ]   0 {0x5} type='A', name='a'\n[*#M ]  11 {0x6} type='B', name='Z: -3 m'\n", (11, "0x6", "Z: -3 m")),
        ("[* ] 1 {0x6} type='B', name='it's'\n", (1, "0x6", "it's")),
        ("nothing of the kind", None),
    ],
)
def test_the_active_step_is_read_from_blenders_list(text: str, expected: Any) -> None:
    assert undo_steps.parse(text) == expected
