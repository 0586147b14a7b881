# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the scenes are: in the wheel as `stiv.scenes`, in a source checkout as `blend_fixtures.scenes`."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from types import ModuleType

from stiv import InputError

CHECKOUT = Path(__file__).resolve().parents[3]


def scene_module(name: str) -> ModuleType:
    """Import a module of the scene library, such as "sessions.catalogue". Raises InputError where there is none."""
    try:
        return importlib.import_module(f"stiv.scenes.{name}")
    except ModuleNotFoundError as error:
        if not (error.name or "").startswith("stiv.scenes"):
            raise
    if not (CHECKOUT / "blend_fixtures" / "scenes").is_dir():
        raise InputError("bench: this installation has no scenes; install the wheel, or run it in a source checkout")
    if str(CHECKOUT) not in sys.path:
        sys.path.append(str(CHECKOUT))
    return importlib.import_module(f"blend_fixtures.scenes.{name}")
