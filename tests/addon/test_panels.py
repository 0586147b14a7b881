# SPDX-License-Identifier: GPL-3.0-or-later
"""Contents of the panels and redo panels, recorded by a layout of plain values."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

bpy = pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

from stiv_addon import panels  # noqa: E402
from stiv_addon.modal.request import Request  # noqa: E402
from stiv_addon.operators.transform.options import TransformOptions  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


class Layout:
    """Blender's layout: children inherit the settings, and all share one record of (call, subject, options)."""

    CHILDREN = frozenset({"row", "column", "box", "split", "grid_flow"})
    RECORDED = frozenset(
        {"prop", "operator", "label", "prop_search", "menu", "separator", "popover", "template_icon", "template_list"}
    )

    def __init__(self, record: list[tuple[str, Any, dict[str, Any]]] | None = None, **settings: bool):
        self.record = [] if record is None else record
        self.use_property_split = settings.get("use_property_split", False)
        self.use_property_decorate = settings.get("use_property_decorate", True)

    def __getattr__(self, name: str) -> Any:
        inherited = {key: self.__dict__[key] for key in ("use_property_split", "use_property_decorate")}
        if name in self.CHILDREN:
            return lambda **options: Layout(self.record, **inherited)
        if name in self.RECORDED:
            return lambda *subject, **options: self._note(name, subject, options | inherited)
        raise AttributeError(name)

    def _note(self, name: str, subject: tuple[Any, ...], options: dict[str, Any]) -> SimpleNamespace:
        self.record.append((name, subject, options))
        return SimpleNamespace()


def drawn(panel: Any) -> list[tuple[str, Any, dict[str, Any]]]:
    layout = Layout()
    panel.draw(SimpleNamespace(layout=layout, bl_label=panel.bl_label), bpy.context)
    return layout.record


@pytest.fixture(autouse=True)
def scene() -> None:
    """A mesh, a list of pairs with one row, and a handle."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.stiv.separation_add()
    bpy.context.object.stiv.deformation = "arap"
    bpy.ops.stiv.handle_add()


@pytest.mark.parametrize("panel", panels.CLASSES, ids=lambda panel: panel.__name__)
def test_settings_have_no_keyframe_dots_and_buttons_have_icons(panel: Any) -> None:
    for call, subject, options in drawn(panel):
        if call == "prop" and options["use_property_split"]:
            assert not options["use_property_decorate"], subject
        if call == "operator" and subject != ("stiv.open_example",):  # its picture is above it
            assert options.get("icon", "NONE") != "NONE", subject


def test_an_automatic_distance_says_auto_and_any_other_is_a_length() -> None:
    settings = bpy.context.scene.stiv
    shown = {subject[1]: options for call, subject, options in drawn(panels.STIV_PT_edit) if call == "prop"}
    assert shown["automatic_separation"]["text"] == "Auto" and "separation" not in shown
    settings.automatic_separation = False
    assert settings.separation > 0.0
    assert "separation" in {subject[1] for call, subject, _ in drawn(panels.STIV_PT_edit) if call == "prop"}
    settings.separation = 0.0  # as stored by version 0.1.0
    assert settings.automatic_separation


OPTIONS = ("proportional", "proportional_size", "responders", "interference", "response")


@pytest.mark.parametrize(
    ("mode", "collisions", "proportional", "expected"),
    [
        ("OBJECT", True, True, {"responders", "interference", "response"}),
        ("OBJECT", False, False, {"interference"}),
        ("EDIT_MESH", True, False, {"proportional", "responders", "interference"}),
        ("EDIT_MESH", False, True, {"proportional", "proportional_size", "interference"}),
    ],
)
def test_the_redo_panel_shows_only_what_applies(
    mode: str, collisions: bool, proportional: bool, expected: set[str]
) -> None:
    request = Request("move", "selected", collisions, "slide")
    operator = SimpleNamespace(proportional=proportional, request=lambda scene: request)
    context = SimpleNamespace(mode=mode, scene=None)
    assert {name for name in OPTIONS if TransformOptions.applies(operator, name, context)} == expected
