# SPDX-License-Identifier: GPL-3.0-or-later
"""The content of the overlay and its removal; tests in a window look at the drawing."""

from types import SimpleNamespace

import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

import stiv_addon  # noqa: E402
from stiv_addon.overlay import display, drawing  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture(autouse=True)
def scene() -> None:
    """Two intersecting boxes."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0.5, 0.25, 0.25))


def test_a_check_shows_what_intersects_until_the_scene_changes() -> None:
    bpy.ops.stiv.check()
    assert len(display.content().intersecting) > 0
    bpy.context.view_layer.update()
    assert len(display.content().intersecting) > 0
    bpy.context.object.location.x = 5.0
    bpy.context.view_layer.update()
    assert not display.content()


def test_the_nearest_pair_is_shown_until_the_scene_changes() -> None:
    bpy.context.object.location.x = 3.0
    assert bpy.ops.stiv.measure() == {"FINISHED"}
    clearance = display.content().clearance
    assert clearance is not None and clearance.distance == pytest.approx(2.0)
    bpy.context.object.location.x = 4.0
    bpy.context.view_layer.update()
    assert display.content().clearance is None


def test_a_drag_shows_contacts_goal_speed_and_on_demand_the_clearance() -> None:
    from stiv.blender import BlenderEdit, EditSettings

    bpy.context.object.location = (3.0, 0.0, 0.0)
    bpy.context.view_layer.update()
    edit = BlenderEdit.begin(bpy.context, EditSettings(separation=0.01), "move")
    matrix = [[1, 0, 0, -2.5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    edit.drag(matrix)
    result = edit.drag(matrix)
    display.show_edit(edit, result)
    shown = display.content()
    assert shown.contacts is not None and len(shown.contacts.triangles) > 0
    assert shown.ghost is not None and shown.ghost.points[:, 0].min() == pytest.approx(0.0)
    assert shown.milliseconds is not None
    assert shown.clearance is not None and shown.clearance.names == ()
    bpy.context.window_manager.stiv_overlay.while_dragging = True
    try:
        display.show_edit(edit, result)
        assert shown.clearance is not None and 0.0 < shown.clearance.distance < 0.1
        assert len(shown.clearance.names) == 2
    finally:
        bpy.context.window_manager.stiv_overlay.while_dragging = False
    display.end_edit()
    assert not display.content()


def test_loading_a_file_clears_it() -> None:
    bpy.ops.stiv.check()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    assert not display.content()


def test_unregistering_leaves_nothing() -> None:
    bpy.ops.stiv.check()
    stiv_addon.unregister()
    try:
        assert not display.content()
        assert not hasattr(bpy.types.WindowManager, "stiv_overlay")
        for name in display.HANDLERS:
            assert not any("stiv" in each.__module__ for each in getattr(bpy.app.handlers, name))
    finally:
        stiv_addon.register()


@pytest.mark.parametrize(
    ("x", "width", "alignment", "edge"),
    [(100, 56, "LEFT", 56), (100, 1, "LEFT", 0), (600, 56, "RIGHT", 0), (44, 56, "LEFT", 0)],
)
def test_texts_are_beside_the_toolbar_where_it_lies_over_the_view(
    x: int, width: int, alignment: str, edge: int
) -> None:
    region = SimpleNamespace(type="WINDOW", x=100, width=600, alignment="NONE")
    tools = SimpleNamespace(type="TOOLS", x=x, width=width, alignment=alignment)
    assert drawing.toolbar_edge(SimpleNamespace(regions=[tools, region]), region) == edge
