# SPDX-License-Identifier: GPL-3.0-or-later
"""Loading another file frees everything that edits keep for the next one."""

import gc
import weakref

import pytest

bpy = pytest.importorskip("bpy")

from stiv.blender import BlenderEdit, EditSettings  # noqa: E402
from stiv.blender.edit import kept_session  # noqa: E402
from stiv.blender.scene import obstacle_choice, static_reading  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


def test_loading_a_file_frees_session_and_obstacles(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obstacle_choice, "MIN_FACES", 0)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_plane_add(location=(0.0, 0.0, -2.0))
    bpy.ops.mesh.primitive_cube_add()
    edit = BlenderEdit.begin(bpy.context, EditSettings(), "move")
    edit.finish()
    del edit
    (known,) = static_reading._latest.values()
    assert kept_session._kept is not None and known.owner.name == "Plane"

    read = weakref.ref(known)
    del known
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    gc.collect()
    assert kept_session._kept is None and read() is None
