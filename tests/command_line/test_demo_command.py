# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv demo`, with and without Blender."""

import importlib.util
from dataclasses import replace

import pytest
from json_schemas import read_valid

from stiv.command_line import demo, program
from stiv.edit_scripts import EditScript, read_edit_script

EDITS = 16  # the first half free, then touching


def test_without_blender_it_says_what_to_install(tmp_path, capsys):
    if importlib.util.find_spec("bpy"):
        pytest.skip("Blender is there")
    assert program.run(["demo", "--output", str(tmp_path / "demo")]) == 2
    assert "pip install bpy" in capsys.readouterr().err
    assert not (tmp_path / "demo").exists()


@pytest.mark.shared
@pytest.mark.blender
def test_it_writes_pictures_scene_and_report_and_checks_what_it_saved(tmp_path, capsys, monkeypatch):
    pytest.importorskip("bpy")

    def shorter(path):
        script = read_edit_script(path)
        return EditScript((replace(script.steps[0], repeat=EDITS),), script.settings)

    monkeypatch.setattr(demo, "read_edit_script", shorter)
    folder = tmp_path / "demo ü"
    assert program.run(["demo", "--output", str(folder)]) == 0
    assert sorted(path.name for path in folder.iterdir()) == ["after.blend", "after.png", "before.png", "report.json"]
    report = read_valid(folder / "report.json", "replay")
    assert len(report["edits"]) == EDITS and sum(edit["rounds"] for edit in report["edits"]) > 0
    assert (folder / "before.png").read_bytes() != (folder / "after.png").read_bytes()
    assert "free of intersections" in capsys.readouterr().out
