# SPDX-License-Identifier: GPL-3.0-or-later
"""F1 leads to an entry in the user guide for each operator."""

import re
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")

from stiv_addon import manual  # noqa: E402
from stiv_addon.operators.classes import CLASSES  # noqa: E402

GUIDE = Path(__file__).resolve().parents[2] / "docs/user_guide.md"


def anchors(text: str) -> list[str]:
    return re.findall(r'<a id="([^"]+)">', text)


@pytest.mark.parametrize("name", [operator.bl_idname for operator in CLASSES])
def test_each_operator_has_an_entry_in_the_guide(name: str) -> None:
    assert anchors(GUIDE.read_text()).count(name) == 1


def test_every_entry_of_the_guide_is_that_of_an_operator() -> None:
    assert set(anchors(GUIDE.read_text())) <= {operator.bl_idname for operator in CLASSES}


def test_the_map_leads_to_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = tmp_path / "user guide.html"
    page.write_text("<!doctype html>")
    monkeypatch.setattr(manual, "PAGE", page)
    manual.register()
    try:
        found = [
            prefix + suffix
            for prefix, entries in bpy.utils.manual_map()
            for pattern, suffix in entries
            if pattern == "bpy.ops.stiv.move"
        ]
    finally:
        manual.unregister()
    assert found == [f"{page.as_uri()}#stiv.move"]
    assert not any(manual.mapping()[0] == prefix for prefix, _ in bpy.utils.manual_map())


def test_the_web_page_keeps_anchors_tables_and_pictures() -> None:
    pytest.importorskip("markdown_it")
    from tools import build_guide

    files = build_guide.files()
    text = files["user_guide.html"].decode()
    assert set(anchors(text)) == set(anchors(GUIDE.read_text()))
    assert "<table>" in text and "<h1>" in text
    assert all(name in files for name in re.findall(r'src="([^"]+)"', text))
