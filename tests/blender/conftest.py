# SPDX-License-Identifier: GPL-3.0-or-later
"""Every test here starts in an empty scene."""

import pytest

bpy = pytest.importorskip("bpy")


@pytest.fixture(autouse=True)
def empty_scene() -> None:
    """A new file with nothing in it."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
