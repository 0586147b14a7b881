# SPDX-License-Identifier: GPL-3.0-or-later
"""The tools and the switch: once they are off, Blender's keys, gizmos, toolbar and header are as before."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

import stiv_addon  # noqa: E402
from stiv_addon.operators.transform import start_drag  # noqa: E402
from stiv_addon.tools import hidden_gizmos, live_keys  # noqa: E402
from stiv_addon.tools.toolbar import TOOL_MODES  # noqa: E402

EVENT = ("idname", "type", "value", "any", "shift", "ctrl", "alt", "oskey", "key_modifier", "direction", "repeat")


@pytest.fixture(scope="module", autouse=True)
def keymap() -> None:
    """Blender's default keymap, which the module without a window does not load."""
    presets = os.path.join(bpy.utils.system_resource("SCRIPTS"), "presets", "keyconfig")
    assert bpy.utils.keyconfig_set(os.path.join(presets, "Blender.py"))


@pytest.fixture
def addon() -> Iterator[None]:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    stiv_addon.register()
    try:
        yield
    finally:
        bpy.context.scene.stiv.live_transforms = False
        stiv_addon.unregister()


def properties(item: Any) -> list[tuple[str, str]]:
    values = dict(item.properties) if item.properties is not None else {}
    return sorted((name, name if hasattr(value, "bl_rna") else repr(value)) for name, value in values.items())


def keys() -> dict[str, list[Any]]:
    """Every key of every keymap that has any."""
    configurations = bpy.context.window_manager.keyconfigs
    configurations.update()
    return {
        f"{name} {keymap.name}": [
            (item.propvalue,) if keymap.is_modal else (*(getattr(item, each) for each in EVENT), item.active,
            [each for each in properties(item) if each[1] != each[0] and "<" not in each[1]])
            for item in keymap.keymap_items
        ]
        for name in ("default", "addon", "user") for keymap in getattr(configurations, name).keymaps
        if len(keymap.keymap_items)
    }  # fmt: skip


def toolbar() -> list[Any]:
    from bl_ui.space_toolsystem_common import ToolSelectPanelHelper

    tools = ToolSelectPanelHelper._tool_class_from_space_type("VIEW_3D")._tools
    return [list(tools[mode]) for mode in TOOL_MODES]


def spaces() -> list[Any]:
    areas = [area for screen in bpy.data.screens for area in screen.areas]
    return [space for area in areas for space in area.spaces if space.type == "VIEW_3D"]


def users_key(name: str) -> Any:
    return next(
        item
        for item in bpy.context.window_manager.keyconfigs.user.keymaps[name].keymap_items
        if item.idname == "transform.translate" and item.value == "PRESS"
    )


def test_unregistering_restores_blender() -> None:
    header = bpy.types.VIEW3D_HT_header
    before = keys(), toolbar(), header.draw_xform_template
    stiv_addon.register()
    bpy.context.scene.stiv.live_transforms = True
    assert keys() != before[0] and toolbar() != before[1] and header.draw_xform_template != before[2]
    bpy.context.scene.stiv.live_transforms = True
    stiv_addon.unregister()
    assert keys() == before[0]
    assert toolbar() == before[1]
    assert header.draw_xform_template == before[2]


def test_the_switch_takes_over_the_users_keys_and_puts_them_back(addon: None) -> None:
    users_key("Mesh").type = "W"
    before = keys()
    bpy.context.scene.stiv.live_transforms = True
    assert bpy.context.scene.stiv.live_guard
    bpy.context.window_manager.keyconfigs.update()  # in a window, Blender does so
    user = bpy.context.window_manager.keyconfigs.user.keymaps
    for name, key in (("Object Mode", "G"), ("Mesh", "W"), ("Lattice", "G"), ("Curve", "G"), ("Pose", "G")):
        first = next(item for item in user[name].keymap_items if item.type == key and not item.shift)
        assert (first.idname, first.properties.kind) == (live_keys.OPERATOR, "move")
    taken = {(item.type, item.properties.kind) for item in user["Lattice"].keymap_items if is_ours(item)}
    assert taken == {("G", "move"), ("R", "rotate"), ("S", "scale"), ("LEFTMOUSE", "move")}
    tool = next(item for item in user["3D View Tool: Rotate"].keymap_items if is_ours(item))
    assert tool.properties.kind == "rotate" and tool.properties.release_confirm
    assert not any(is_ours(item) for item in user["Armature"].keymap_items)
    assert not any(is_ours(item) for item in user["3D View"].keymap_items), "the key of the 3D cursor"
    bpy.context.scene.stiv.live_transforms = False
    assert keys() == before
    bpy.context.window_manager.keyconfigs.user.keymaps["Mesh"].restore_to_default()


def is_ours(item: Any) -> bool:
    return item.idname == live_keys.OPERATOR


def test_gizmos_are_hidden_in_a_view_and_saved_as_the_user_chose(addon: None, tmp_path: Path) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    space, name = spaces()[0], hidden_gizmos.OBJECT["move"]
    space.show_gizmo_object_translate = True
    hidden_gizmos.hide_only(space, [name, hidden_gizmos.TOOL])
    assert not space.show_gizmo_object_translate and not space.show_gizmo_tool
    assert hidden_gizmos.chosen(space, name) and not hidden_gizmos.chosen(space, hidden_gizmos.OBJECT["scale"])
    space.show_gizmo_object_translate = True  # a click on the box that looks off
    hidden_gizmos.hide_only(space, [name, hidden_gizmos.TOOL])
    assert not space.show_gizmo_object_translate and not hidden_gizmos.chosen(space, name)
    hidden_gizmos.hide_only(space, [name])
    assert space.show_gizmo_tool
    space.show_gizmo_object_translate = True
    hidden_gizmos.hide_only(space, [name])
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"))
    assert space.show_gizmo_object_translate
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "saved.blend"))
    assert any(each.show_gizmo_object_translate for each in spaces())


def test_only_selections_with_surfaces_collide(addon: None) -> None:
    scene, collection = bpy.context.scene, bpy.context.scene.collection
    mesh = bpy.data.objects.new("Mesh", bpy.data.meshes.new("Mesh"))
    empty, lamp = bpy.data.objects.new("Empty", None), bpy.data.objects.new("Lamp", bpy.data.lights.new("L", "POINT"))
    for obj in (mesh, empty, lamp):
        collection.objects.link(obj)

    def collides(*selected: Any) -> bool:
        for obj in scene.objects:
            obj.select_set(obj in selected)
        return start_drag.may_collide(bpy.context)

    assert collides(mesh) and collides(mesh, lamp)
    assert not collides(lamp) and not collides(empty) and not collides()
    mesh.parent = empty
    assert collides(empty)
    scene.tool_settings.use_transform_skip_children = True
    assert not collides(empty)
    scene.tool_settings.use_transform_skip_children = False
    mesh.stiv.role = "ignored"
    assert not collides(mesh)


def test_a_lock_becomes_blenders_constraint() -> None:
    """Checked against the constraints of Blender's own gizmo."""
    assert start_drag.constrained_axes(-1, False) == (False, False, False)
    assert start_drag.constrained_axes(1, False) == (False, True, False)
    assert start_drag.constrained_axes(2, True) == (True, True, False)
