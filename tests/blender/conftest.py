# SPDX-License-Identifier: GPL-3.0-or-later
"""Every test here starts in an empty scene."""

import pytest

bpy = pytest.importorskip("bpy")


@pytest.fixture(autouse=True)
def empty_scene() -> None:
    """A new file with nothing in it; preferences and add-ons stay, because reading them takes eight times as long."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
