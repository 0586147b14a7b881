# SPDX-License-Identifier: GPL-3.0-or-later
"""The live guard in Blender: when it watches, what it ignores, and its cleanup."""

from collections.abc import Iterator
from typing import Any

import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

from guarding import FURTHEST, box, expect_free, look, move, names_of_steps, watched_scene  # noqa: E402

import stiv_addon  # noqa: E402
from stiv_addon.guard import watcher  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture(autouse=True)
def scene() -> Iterator[None]:
    yield from watched_scene()


def test_undo_to_before_the_guard_was_on_leaves_it_on() -> None:
    bpy.context.scene.stiv.live_guard = False
    move(2.4)
    move(-2.4)
    bpy.context.scene.stiv.live_guard = True
    bpy.ops.ed.undo_push(message="guard on")
    look()
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    assert box().location.x == pytest.approx(2.4)
    assert bpy.context.scene.stiv.live_guard
    look()
    expect_free()


def test_a_scene_that_intersects_is_named_and_watched_again_once_it_is_free() -> None:
    bpy.context.scene.stiv.live_guard = False
    box().location.x = 2.4
    bpy.context.view_layer.update()
    bpy.context.scene.stiv.live_guard = True
    look()
    assert watcher.problem().names == ["Box", "Wall"]
    assert box().location.x == pytest.approx(2.4)  # nothing was written
    move(-3.4)
    look()
    assert watcher.problem() is None
    move(7.0)
    look()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)


def test_a_second_observation_does_nothing() -> None:
    move(7.0)
    look()
    shown, steps = tuple(box().location), names_of_steps()
    for _ in range(3):
        watcher._note_change()
        look()
    assert tuple(box().location) == shown
    assert names_of_steps() == steps


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
def test_its_own_reading_is_not_a_change(mode: str) -> None:
    """Blender marks a mesh that was read in Edit Mode as changed; the guard once tested it every second."""
    bpy.ops.object.mode_set(mode=mode)
    for _ in range(2):
        look()
        noted = watcher._watch.updates
        bpy.context.view_layer.update()
        assert watcher._watch.updates == noted
        move(0.1)


def test_a_loaded_file_is_watched_if_its_guard_is_on(tmp_path: Any) -> None:
    path = str(tmp_path / "guarded scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.context.scene.stiv.live_guard = False
    bpy.ops.wm.open_mainfile(filepath=path)
    assert bpy.app.timers.is_registered(watcher.observe_and_act)
    look()
    bpy.ops.ed.undo_push(message="loaded")
    look()
    bpy.context.view_layer.objects.active = box()
    move(7.0)
    look()
    assert box().location.x == pytest.approx(FURTHEST, abs=0.02)


def test_turned_off_it_leaves_no_timer_and_does_nothing() -> None:
    bpy.context.scene.stiv.live_guard = False
    assert not bpy.app.timers.is_registered(watcher.observe_and_act)
    move(2.4)
    assert not bpy.app.timers.is_registered(watcher.observe_and_act)
    assert box().location.x == pytest.approx(2.4)


def test_unregistering_leaves_no_handler_and_no_timer() -> None:
    watcher._note_change()
    stiv_addon.unregister()
    try:
        for name in watcher.HANDLERS:
            assert not any("stiv" in each.__module__ for each in getattr(bpy.app.handlers, name))
        assert not bpy.app.timers.is_registered(watcher.observe_and_act)
    finally:
        stiv_addon.register()
