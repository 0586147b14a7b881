# SPDX-License-Identifier: GPL-3.0-or-later
"""The accessor gives the names of `stiv.blender`, and imports the package only for them."""

import sys

import pytest

pytest.importorskip("bpy")

import stiv
from stiv.blender import EditSettings
from stiv_addon import stiv_blender


def test_names_are_those_of_the_packages() -> None:
    assert stiv_blender.EditSettings is EditSettings
    assert stiv_blender.InputError is stiv.InputError
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = stiv_blender.no_such_name


def test_names_of_the_import_system_do_not_import_the_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "stiv.blender", None)
    assert not hasattr(stiv_blender, "__path__")
    with pytest.raises(ImportError):
        _ = stiv_blender.EditSettings
