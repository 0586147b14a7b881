# SPDX-License-Identifier: GPL-3.0-or-later
"""F1 on an operator opens its entry in the user guide, a web page in the extension."""

from __future__ import annotations

from pathlib import Path

import bpy

from .operators.classes import CLASSES

PAGE = Path(__file__).with_name("guide") / "user_guide.html"


def mapping() -> tuple[str, tuple[tuple[str, str], ...]]:
    """The address of the page, and the anchor of each operator."""
    names = [operator.bl_idname for operator in CLASSES]
    return f"{PAGE.as_uri()}#", tuple((f"bpy.ops.{name}", name) for name in names)


def register() -> None:
    """Add the map if the page exists; an extension run from its sources has none."""
    if PAGE.is_file():
        bpy.utils.register_manual_map(mapping)


def unregister() -> None:
    """Remove the map."""
    if PAGE.is_file():
        bpy.utils.unregister_manual_map(mapping)
