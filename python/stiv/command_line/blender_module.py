# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender as a Python module: imported only for a .blend, with a clear error where it is missing."""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

from stiv import InputError

HOW_TO_GET_IT = (
    "install Blender as a Python module with `pip install bpy` (4.2 to 5.0 for Python 3.11, 5.1 and later for 3.13), "
    "or run stiv with the Python of a virtual environment that has it"
)


def require_blender(name: str, path: Path) -> ModuleType:
    """The module `name` of stiv.blender, or `stiv_addon`. Raises InputError if Blender's module is not installed."""
    if importlib.util.find_spec("bpy") is None:
        raise InputError(f"{path}: a .blend needs Blender's Python module, which is not installed; {HOW_TO_GET_IT}")
    return importlib.import_module(name)


@contextmanager
def addon_registered(path: Path) -> Iterator[None]:
    """Has the add-on's operators and settings in Blender; takes them away again if they were not there before.

    Raises InputError where Blender's module or the add-on is not installed.
    """
    if require_blender("stiv.blender.scripts.enabling", path).is_enabled():
        yield
        return
    try:
        addon = require_blender("stiv_addon", path)
    except ModuleNotFoundError as error:
        if error.name != "stiv_addon":
            raise
        raise InputError(f"{path}: the add-on is missing beside the package stiv; install STIV's wheel") from error
    addon.register()
    try:
        yield
    finally:
        addon.unregister()


def stored_settings(context: Any, path: Path) -> Any:
    """The settings that the add-on has stored in the open scene; the defaults where the add-on is not installed."""
    if importlib.util.find_spec("stiv_addon") is None:
        return require_blender("stiv.blender", path).EditSettings()
    with addon_registered(path):
        return require_blender("stiv_addon.scene.edit_settings", path).edit_settings(context.scene)


@contextmanager
def quiet_blender(*, errors: bool = False) -> Iterator[None]:
    """Within, Blender prints nothing on standard output, where it writes beneath Python. Progress bars still show.

    errors: nor on standard error, where renders complain of displays that they do not need.
    """
    sys.stdout.flush()
    streams = (1, 2) if errors else (1,)
    copies = [os.dup(stream) for stream in streams]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream in streams:
            os.dup2(nowhere, stream)
        yield
    finally:
        for stream, copy in zip(streams, copies, strict=True):
            os.dup2(copy, stream)
            os.close(copy)
        os.close(nowhere)
