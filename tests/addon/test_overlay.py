# SPDX-License-Identifier: GPL-3.0-or-later
"""What the overlay holds, and that nothing of it stays; drawing itself is looked at in a window."""

from collections.abc import Iterator

import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

import stiv_addon  # noqa: E402
from stiv_addon.overlay import showing  # noqa: E402


@pytest.fixture(scope="module", autouse=True)
def registered() -> Iterator[None]:
    stiv_addon.register()
    yield
    stiv_addon.unregister()


@pytest.fixture(autouse=True)
def scene() -> None:
    """Two boxes through each other."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0.5, 0.25, 0.25))


def test_a_check_shows_what_intersects_until_the_scene_changes() -> None:
    bpy.ops.stiv.check()
    assert len(showing.content().intersecting) > 0
    bpy.context.view_layer.update()
    assert len(showing.content().intersecting) > 0
    bpy.context.object.location.x = 5.0
    bpy.context.view_layer.update()
    assert not showing.content()


def test_the_nearest_pair_is_shown_until_the_scene_changes() -> None:
    bpy.context.object.location.x = 3.0
    assert bpy.ops.stiv.measure() == {"FINISHED"}
    clearance = showing.content().clearance
    assert clearance is not None and clearance.distance == pytest.approx(2.0)
    bpy.context.object.location.x = 4.0
    bpy.context.view_layer.update()
    assert showing.content().clearance is None


def test_loading_a_file_clears_it() -> None:
    bpy.ops.stiv.check()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    assert not showing.content()


def test_unregistering_leaves_nothing() -> None:
    bpy.ops.stiv.check()
    stiv_addon.unregister()
    try:
        assert not showing.content()
        assert not hasattr(bpy.types.WindowManager, "stiv_overlay")
        for name in showing.HANDLERS:
            assert not any("stiv" in each.__module__ for each in getattr(bpy.app.handlers, name))
    finally:
        stiv_addon.register()
