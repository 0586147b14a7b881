# SPDX-License-Identifier: GPL-3.0-or-later
"""The undo list as Blender prints it, and flushing the C library that Blender prints with."""

import ctypes
import sys
import types

import pytest

pytest.importorskip("bpy")

import bpy

from stiv_addon.guard import undo_steps


@pytest.mark.parametrize(("platform", "library"), [("win32", "ucrtbase"), ("linux", None), ("darwin", None)])
def test_the_c_library_of_blender_is_flushed(monkeypatch: pytest.MonkeyPatch, platform: str, library: str) -> None:
    flushed: list[object] = []
    load = lambda name: types.SimpleNamespace(fflush=lambda stream: flushed.append((name, stream)))  # noqa: E731
    monkeypatch.setattr(ctypes, "CDLL", load)
    monkeypatch.setattr(sys, "platform", platform)
    undo_steps._flush()
    assert flushed == [(library, None)]


def test_the_active_step_is_read_from_lines_of_any_system() -> None:
    text = "Undo 2 Steps\r\n[ # ]   0 {000001F2A} type='Global Undo', name='Original'\r\n"
    text += "[*#M]   1 {000001F2B} type='Global Undo', name='Move'\r\n"
    assert undo_steps.parse(text) == (1, "000001F2B", "Move")


@pytest.mark.parametrize(("kind", "is_replaced"), [("Edit Mesh", True), ("Edit Curve", True), ("Global Undo", False)])
def test_only_a_step_of_an_edit_mode_is_completed(
    monkeypatch: pytest.MonkeyPatch, kind: str, is_replaced: bool
) -> None:
    """A global one holds the whole file."""
    replaced: list[str] = []
    text = f"[    ]   0 {{0x1}} type='Global Undo', name='Original'\n[*   ]   1 {{0x2}} type='{kind}', name='Levels'\n"
    monkeypatch.setattr(undo_steps, "_stack", lambda: text)
    monkeypatch.setattr(undo_steps, "replace_active", lambda window, name: replaced.append(name))
    undo_steps.complete_active(bpy.context.window)
    assert replaced == (["Levels"] if is_replaced else [])


@pytest.mark.parametrize(("later", "is_replaced"), [("", True), ("[   S]", True), ("[    ]", False), ("[ #  ]", False)])
def test_a_step_before_others_is_completed_only_for_a_new_one(
    monkeypatch: pytest.MonkeyPatch, later: str, is_replaced: bool
) -> None:
    """A replaced step ends what could be redone."""
    replaced: list[str] = []
    text = "[ #M ]   0 {0x1} type='Global Undo', name='Original'\n[*   ]   1 {0x2} type='Edit Mesh', name='A'\n"
    text += f"{later}   2 {{0x3}} type='Edit Mesh', name='[Move]'\n" if later else ""
    monkeypatch.setattr(undo_steps, "_stack", lambda: text)
    monkeypatch.setattr(undo_steps, "replace_active", lambda window, name: replaced.append(name))
    assert undo_steps.complete_last(bpy.context.window) == is_replaced
    assert replaced == (["A"] if is_replaced else [])


FILE, SKIPPED_FILE = (f"[{flags}]   0 {{0x1}} type='Global Undo', name='Any'\n" for flags in (" #M ", " #MS"))
EDITED = "[*   ]   1 {0x2} type='Edit Mesh', name='A'\n"


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize(
    ("lines", "is_complete"),
    [
        (FILE + EDITED, False),
        (SKIPPED_FILE + EDITED, True),
        (SKIPPED_FILE + EDITED.replace("*", " ") + EDITED, False),
    ],
)
def test_a_complete_step_is_neither_replaced_nor_added_again(
    monkeypatch: pytest.MonkeyPatch, lines: str, is_complete: bool, end: str
) -> None:
    """The whole file is stored immediately before it."""
    stored: list[str] = []
    monkeypatch.setattr(undo_steps, "_stack", lambda: lines.replace("\n", end))
    monkeypatch.setattr(undo_steps, "replace_active", lambda window, name: stored.append(name))
    monkeypatch.setattr(undo_steps, "push", lambda window, name: stored.append(name))
    assert undo_steps.complete_last(bpy.context.window)
    undo_steps.add_start()
    assert stored == ([] if is_complete else ["A", "A"])
