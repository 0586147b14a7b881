# SPDX-License-Identifier: GPL-3.0-or-later
"""The package `stiv.blender`, imported at first use: the add-on registers where its native module is missing."""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from stiv import CancelledError as CancelledError
    from stiv import CancelToken as CancelToken
    from stiv import EditResult as EditResult
    from stiv import InputError as InputError
    from stiv import LeastDistance as LeastDistance
    from stiv import self_test as self_test
    from stiv.blender import *  # noqa: F403
    from stiv.checks.findings import untested_text as untested_text

    Edit = BlenderEdit  # noqa: F405
    Reshaping = BlenderContraction | BlenderExpansion | BlenderRepair | LayoutTask  # noqa: F405
else:

    def __getattr__(name: str) -> object:
        for package in () if name.startswith("__") else ("stiv.blender", "stiv", "stiv.checks.findings"):
            found = getattr(importlib.import_module(package), name, None)
            if found is not None:
                return found
        raise AttributeError(name)
