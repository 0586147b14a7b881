# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether the native module can be loaded, and operators that are disabled without it."""

from __future__ import annotations

import functools
import importlib
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy

    class Mixin(bpy.types.Operator):
        """Base of the operators' mixins, with the members of an operator."""
else:

    class Mixin:
        """Base of the operators' mixins; without bpy, which tests of this module do not need."""


_calls: list[Callable[[], object]] | None = []  # due once the module is loaded; None from then on


def when_loaded(call: Callable[[], object]) -> None:
    """Make a call once the native module is loaded; at once if it is."""
    if _calls is None:
        call()
    else:
        _calls.append(call)


@functools.cache
def problem() -> str:
    """Why the add-on cannot run, one sentence a line; empty if it can. Determined once per session."""
    try:
        importlib.import_module("stiv._native")
        importlib.import_module("stiv.blender")
    except ImportError as error:
        return _explanation(error)
    _make_calls()
    return ""


def _make_calls() -> None:
    global _calls
    due, _calls = _calls or (), None
    for call in due:
        call()


def _explanation(error: ImportError) -> str:
    version = f"{sys.version_info.major}.{sys.version_info.minor}"
    if isinstance(error, ModuleNotFoundError) and (error.name or "").partition(".")[0] == "stiv":
        reason = f"STIV's native module for Python {version} is missing."
    else:
        reason = f"STIV's native module cannot be loaded: {error}."
    return f"{reason}\nInstall an extension zip with a wheel for Python {version}, then restart Blender."


class NeedsNativeModule(Mixin):
    """Base of operators with geometry; a subclass adds its own conditions in `is_available`."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Whether the native module and the operator are available."""
        if problem():
            cls.poll_message_set(problem())
            return False
        return cls.is_available(context)

    @classmethod
    def is_available(cls, context: bpy.types.Context) -> bool:
        """Whether the context allows the operator; subclasses override this."""
        return True
