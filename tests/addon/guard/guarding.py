# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the tests of the live guard: a watched scene, and a call in place of the timer, which does not run here."""

import time
from collections.abc import Iterator
from typing import Any

import bpy

from stiv.blender import check_scene
from stiv_addon.guard import undo_steps, watcher

FURTHEST = 1.5  # of the box's centre: the wall's face is at 2, the box is 1 wide


def watched_scene() -> Iterator[None]:
    """A selected box in front of a wall, with the guard on; the undo history begins with it."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(2.5, 0, 0), scale=(1, 4, 4))
    bpy.context.object.name = "Wall"
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.context.object.name = "Box"
    bpy.context.scene.stiv.live_guard = True
    bpy.ops.ed.undo_push(message="start")
    look()
    yield
    bpy.context.scene.stiv.live_guard = False


def look() -> None:
    """Call the timer's function until it is done."""
    deadline = time.monotonic() + 600.0  # of a busy machine
    while watcher.observe_and_act() is not None:
        assert time.monotonic() < deadline, "the guard never settles"
        time.sleep(0.02)


def box() -> Any:
    return bpy.data.objects["Box"]


def move(x: float) -> None:
    bpy.ops.transform.translate("EXEC_DEFAULT", True, value=(x, 0, 0))


def expect_free() -> None:
    assert check_scene(bpy.context).pairs == ()


def names_of_steps() -> list[str]:
    """Names of the undo steps, without those that Blender adds for itself and skips when it undoes."""
    found = [line.split("name=")[1].strip("'") for line in undo_steps._printed().splitlines() if "name=" in line]
    return [name for name in found if not name.startswith("MemFile Internal")]
