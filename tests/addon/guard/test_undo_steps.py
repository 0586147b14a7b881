# SPDX-License-Identifier: GPL-3.0-or-later
"""The undo list as Blender prints it, and flushing the C library that Blender prints with."""

import ctypes
import sys
import types

import pytest

pytest.importorskip("bpy")

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
