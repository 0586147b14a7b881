# SPDX-License-Identifier: GPL-3.0-or-later
"""When an operator needs the undo step of its start to hold the whole file, and what that step stores."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

pytest.importorskip("bpy")

import bpy

from stiv.blender.scene.temporary_data import note_copies
from stiv_addon.guard import undo_steps
from stiv_addon.operators.start_step import StartStep


@pytest.mark.parametrize(
    ("mode", "sets", "copies", "expected"),
    [
        ("OBJECT", True, True, False),
        ("EDIT", False, False, False),
        ("EDIT", True, False, True),
        ("EDIT", False, True, True),
    ],
)
def test_it_is_needed_after_copies_or_settings_in_an_edit_mode(
    monkeypatch: pytest.MonkeyPatch, mode: str, sets: bool, copies: bool, expected: bool
) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.object.mode_set(mode=mode)
    seen: list[str] = []
    monkeypatch.setattr(undo_steps, "add_start", lambda: seen.append("stored"))

    @contextmanager
    def start_shown() -> Iterator[None]:
        seen.append("start")
        yield
        seen.append("present")

    step = StartStep(sets)
    if copies:
        note_copies()
    step.add(bpy.context, start_shown)
    assert seen == (["start", "stored", "present"] if expected else [])
    assert step.is_needed(bpy.context) == expected


@pytest.mark.parametrize("is_cancelled", [False, True])
def test_a_timer_stores_it_while_the_operator_waits(monkeypatch: pytest.MonkeyPatch, is_cancelled: bool) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.object.mode_set(mode="EDIT")
    stored: list[object] = []
    monkeypatch.setattr(undo_steps, "complete_active", stored.append)
    step = StartStep(sets=True)
    assert not step.wait(bpy.context) and not stored  # the timer has not run yet: without a window, none does
    if is_cancelled:
        step.cancel()
    step._complete()
    assert len(stored) == (0 if is_cancelled else 1) and step.wait(bpy.context) != is_cancelled
