# SPDX-License-Identifier: GPL-3.0-or-later
"""Preferences, pie menu and keys: registered, used, and removed."""

from types import SimpleNamespace
from typing import Any

import pytest

bpy = pytest.importorskip("bpy")

import stiv_addon  # noqa: E402
from stiv_addon import keymap, menus, preferences  # noqa: E402
from stiv_addon.scene import edit_settings as settings  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


class Layout:
    """Replaces Blender's layout, and records its contents."""

    def __init__(self) -> None:
        self.put: list[str] = []

    def menu_pie(self) -> "Layout":
        return self

    def operator(self, name: str, text: str = "") -> None:
        assert hasattr(bpy.types, name.replace("stiv.", "STIV_OT_"))
        self.put.append(name)

    def prop(self, owner: Any, name: str) -> None:
        assert name in owner.bl_rna.properties
        self.put.append(name)


def our_keys() -> list[Any]:
    configuration = bpy.context.window_manager.keyconfigs.addon
    return [item for keys in configuration.keymaps for item in keys.keymap_items if keymap.is_ours(item)]


def test_the_pie_has_its_eight_places_filled() -> None:
    layout = Layout()
    menus.STIV_MT_pie.draw(SimpleNamespace(layout=layout), bpy.context)
    assert len(layout.put) == len(set(layout.put)) == 8
    assert layout.put[:4] == ["stiv.move", "stiv.rotate", "stiv.scale", "stiv.check"]


def test_the_search_finds_every_tool_by_collision() -> None:
    """Blender's search (F3) walks the menus of a mode."""
    layout = Layout()
    menus.STIV_MT_tools.draw(SimpleNamespace(layout=layout), bpy.context)
    labels = [getattr(bpy.ops.stiv, name.partition(".")[2]).get_rna_type().name for name in layout.put]
    assert len(labels) >= 10 and all("Collision" in label for label in labels), labels
    for name in menus.TOOL_MENUS:
        assert menus.draw_tools in getattr(bpy.types, name)._dyn_ui_initialize()


def test_every_key_belongs_to_the_extension_and_none_stays() -> None:
    assert len(our_keys()) == len(keymap.KEYMAPS) * (len(keymap.KEYS) + 1) - len(keymap.TAKEN)
    stiv_addon.unregister()
    try:
        assert our_keys() == []
    finally:
        stiv_addon.register()


def test_without_being_enabled_all_threads_and_the_overlay_are_used() -> None:
    assert preferences.threads(bpy.context) == 0
    assert preferences.overlay_at_start(bpy.context)


def test_threads_of_the_preferences_are_used(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("stiv._native")
    chosen = SimpleNamespace(threads=3, overlay=False)
    monkeypatch.setattr(preferences, "preferences", lambda context: chosen)
    assert settings.edit_settings(bpy.context.scene).threads == 3
    stiv_addon.unregister()
    stiv_addon.register()
    assert not bpy.context.window_manager.stiv_overlay.show
