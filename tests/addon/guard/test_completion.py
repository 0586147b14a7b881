# SPDX-License-Identifier: GPL-3.0-or-later
"""When the undo step of an edit mode is completed after objects were copied."""

from collections.abc import Iterator

import pytest

pytest.importorskip("bpy")

import bpy

from stiv_addon.guard import alerts, completion, undo_steps, watcher


@pytest.fixture(autouse=True)
def cube() -> Iterator[None]:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add()
    completion.copied()
    yield
    completion.completed()


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[bool]:
    """The answers of the next calls; the last one stays."""
    answers = [True]
    monkeypatch.setattr(undo_steps, "complete_last", lambda window: answers.pop() if answers else pytest.fail("again"))
    return answers


@pytest.mark.parametrize(("owner", "name"), [(alerts, "is_busy"), (watcher, "is_working")])
def test_it_waits_for_tools_and_the_guard(
    monkeypatch: pytest.MonkeyPatch, asked: list[bool], owner: object, name: str
) -> None:
    bpy.ops.object.mode_set(mode="EDIT")
    monkeypatch.setattr(owner, name, lambda: True)
    assert completion._complete() == completion.INTERVAL and asked
    monkeypatch.setattr(owner, name, lambda: False)
    assert completion._complete() is None and not asked
    assert completion._complete() is None  # not due any more


def test_steps_outside_edit_modes_hold_the_whole_file(asked: list[bool]) -> None:
    assert completion._complete() is None and asked
    bpy.ops.object.mode_set(mode="EDIT")
    assert completion._complete() is None and asked


def test_it_is_tried_again_if_steps_could_be_redone(asked: list[bool]) -> None:
    bpy.ops.object.mode_set(mode="EDIT")
    asked[:] = [True, False]
    assert completion._complete() is None and asked == [True]
    assert completion._complete() is None and not asked
