# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators for scripts without the extension; test_examples runs the guide's script in a separate process."""

import sys

import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

import stiv  # noqa: E402
from stiv.blender import enable  # noqa: E402
from stiv.blender.scripts.enabling import is_enabled  # noqa: E402


def test_a_missing_addon_is_reported_with_the_way_out(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not is_enabled()
    monkeypatch.setitem(sys.modules, "stiv_addon", None)
    with pytest.raises(stiv.InputError, match="enable the extension, or install STIV's wheel with pip"):
        enable()
    assert not is_enabled()


def test_enabling_a_registered_addon_does_nothing(registered: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "stiv_addon", None)
    enable()
    assert is_enabled()
