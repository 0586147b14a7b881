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
    """Imports a module of stiv.blender or stiv_addon. Raises InputError if Blender's module is not installed."""
    if importlib.util.find_spec("bpy") is None:
        raise InputError(f"{path}: Blender's Python module is not installed; {HOW_TO_GET_IT}")
    return importlib.import_module(name)


@contextmanager
def addon_registered(path: Path) -> Iterator[None]:
    """Context in which the add-on is registered. Unregisters it afterwards unless it was registered before.

    Raises InputError if Blender's module or the add-on is not installed.
    """
    if require_blender("stiv.blender.scripts.enabling", path).is_enabled():
        yield
        return
    try:
        addon = require_blender("stiv_addon", path)
    except ModuleNotFoundError as error:
        if error.name != "stiv_addon":
            raise
        raise InputError(f"{path}: the package stiv_addon is missing; install the wheel of STIV") from error
    addon.register()
    try:
        yield
    finally:
        addon.unregister()


def stored_settings(context: Any, path: Path) -> Any:
    """The add-on's settings of the open scene, or the defaults if the add-on is not installed."""
    if importlib.util.find_spec("stiv_addon") is None:
        return require_blender("stiv.blender", path).EditSettings()
    with addon_registered(path):
        return require_blender("stiv_addon.scene.edit_settings", path).edit_settings(context.scene)


@contextmanager
def quiet_blender(*, errors: bool = False) -> Iterator[None]:
    """Context in which Blender's own messages do not reach standard output. Progress bars do.

    errors: also suppress its messages on standard error, such as warnings of renders without a display.
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
