# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets, and the report that a user copies into an issue."""

import pytest

bpy = pytest.importorskip("bpy")

import stiv  # noqa: E402
from stiv_addon.getting_started import presets, report  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")


@pytest.mark.parametrize("name", presets.VALUES)
def test_a_preset_sets_its_values_in_one_undo_step(name):
    assert bpy.ops.stiv.apply_preset(preset=name) == {"FINISHED"}
    settings = bpy.context.scene.stiv
    for key, value in presets.VALUES[name].items():
        assert getattr(settings, key) == pytest.approx(value)


def test_presets_have_values():
    assert {identifier for identifier, _, _ in presets.PRESETS} == set(presets.VALUES)


def test_the_report_names_versions_settings_messages_and_the_self_test():
    bpy.ops.wm.read_factory_settings(use_empty=False)
    bpy.context.scene.stiv.smoothness = 0.25
    bpy.context.object.name = "Secret"
    bpy.ops.stiv.move(value=(0.1, 0.0, 0.0))
    text = report.report_text(bpy.context)
    assert bpy.app.version_string in text
    assert "smoothness: 0.25" in text
    assert "STIV_OT_move: INFO" in text
    result = stiv.self_test()
    assert f"passed: edits {result.edits}, intersections {result.intersections}" in text
    assert "Secret" not in text
    assert bpy.utils.resource_path("USER") not in text
