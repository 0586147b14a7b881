# SPDX-License-Identifier: GPL-3.0-or-later
"""F1 on an operator opens its place in the user guide, which the extension brings along as a web page."""

from __future__ import annotations

from pathlib import Path

import bpy

from .operators import CLASSES

PAGE = Path(__file__).with_name("guide") / "user_guide.html"


def mapping() -> tuple[str, tuple[tuple[str, str], ...]]:
    """Where the page is, and for each operator the anchor that carries its name."""
    names = [operator.bl_idname for operator in CLASSES]
    return f"{PAGE.as_uri()}#", tuple((f"bpy.ops.{name}", name) for name in names)


def register() -> None:
    """Add the map, where the page is there: run from its sources, the extension has none."""
    if PAGE.is_file():
        bpy.utils.register_manual_map(mapping)


def unregister() -> None:
    """Take it away."""
    if PAGE.is_file():
        bpy.utils.unregister_manual_map(mapping)
