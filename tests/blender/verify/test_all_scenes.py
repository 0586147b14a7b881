# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv check` of files with several scenes, hidden objects, render levels and objects without a surface."""

import json
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import bpy
import pytest
from building import CUBE, CUBE_FACES, add, add_cube, add_grid, add_modifier, mesh

from stiv.blender.scene import guarded_evaluations, strand_reading
from stiv.blender.scripts.blend_files import save_blend
from stiv.command_line import program
from stiv.pytest_plugin import _check

SCHEMA = Path(program.__file__).parents[1] / "schemas/check.schema.json"


def checked(folder: Path, *options: str) -> tuple[int, dict]:
    """Exit code and the report on the open scene's file, valid by the schema."""
    scene, report = folder / "film ü.blend", folder / "report.json"
    save_blend(scene)
    code = program.run(["check", str(scene), "--json", str(report), *options])
    if code not in (0, 4):
        return code, {}
    data = json.loads(report.read_text(encoding="utf-8"))
    pytest.importorskip("jsonschema").validate(data, json.loads(SCHEMA.read_text()))
    return code, data["files"][0]


def second_scene() -> None:
    """Two cubes that meet, in another scene than the open one."""
    scene = bpy.data.scenes.new("Shot 2")
    for name, place in (("Second A", (0, 0, 0)), ("Second B", (0.5, 0.4, 0.3))):
        ob = bpy.data.objects.new(name, mesh(name, CUBE, CUBE_FACES))
        ob.location = place
        scene.collection.objects.link(ob)


def test_all_scenes_are_tested_unless_one_is_named(tmp_path: Path, capsys) -> None:
    add_cube("First")
    second_scene()
    code, file = checked(tmp_path, "--junit", str(tmp_path / "junit.xml"))
    assert code == 4 and file["scenes"] == ["Scene", "Shot 2"]
    assert {pair["scene"] for pair in file["pairs"]} == {"Shot 2"}
    said = capsys.readouterr().out
    assert "2 scenes" in said and '  scene "Shot 2": object "Second A", face' in said
    (suite,) = ElementTree.parse(tmp_path / "junit.xml").getroot()
    failed = {case.get("name"): case.find("failure") is not None for case in suite.findall("testcase")}
    assert failed == {'scene "Scene"': False, 'scene "Shot 2"': True}
    assert checked(tmp_path, "--scene", "Scene")[0] == 0
    code, file = checked(tmp_path, "--scene", "Shot 2", "--frames", "1:2")
    assert code == 4 and file["scenes"] == ["Shot 2"] and "scene" not in file["pairs"][0]
    assert checked(tmp_path, "--object", "Second A")[0] == 0
    assert checked(tmp_path, "--scene", "Shot 3")[0] == 2
    assert 'there is no scene "Shot 3" in it; there are Scene, Shot 2' in capsys.readouterr().err
    assert checked(tmp_path, "--scene", "Scene", "--object", "Second A")[0] == 2
    assert _check(tmp_path / "film ü.blend", ["--scene=Scene"]) == ""


def test_hidden_objects_are_counted_and_tested_on_request(tmp_path: Path, capsys) -> None:
    add_cube("Shown")
    for name, place in (("Eye", (0.5, 0.4, 0.3)), ("Monitor", (0.4, 0.5, 0.3)), ("Excluded", (0.3, 0.4, 0.5))):
        add_cube(name, place, hide_render=True)
    bpy.data.objects["Monitor"].hide_viewport = True
    collection = bpy.data.collections.new("Old")
    bpy.context.scene.collection.children.link(collection)
    bpy.context.collection.objects.unlink(bpy.data.objects["Excluded"])
    collection.objects.link(bpy.data.objects["Excluded"])
    bpy.context.view_layer.layer_collection.children["Old"].exclude = True
    bpy.data.objects["Eye"].hide_set(True)
    code, file = checked(tmp_path)
    assert code == 0 and file["objects"] == ["Shown"]
    assert file["untested_counts"] == {"hidden": 2, "in an excluded collection": 1}
    said = 'not tested, hidden: 2 ("Eye", "Monitor"); in an excluded collection: 1 ("Excluded")'
    assert said in capsys.readouterr().out
    code, file = checked(tmp_path, "--hidden")
    assert code == 4 and sorted(file["objects"]) == ["Excluded", "Eye", "Monitor", "Shown"]
    assert file["untested_counts"] == {} and file["intersections"] > 0


def test_objects_that_are_only_rendered_are_tested(tmp_path: Path) -> None:
    add_cube("Shown")
    add_cube("Rendered", (0.5, 0.4, 0.3)).hide_set(True)
    code, file = checked(tmp_path)
    assert code == 4 and all(pair["rendered"] for pair in file["pairs"]) and file["untested"] == []
    bpy.data.objects["Rendered"].hide_render = True
    assert checked(tmp_path)[0] == 0


def smooth_cube_in_a_box() -> None:
    """A cube that is smooth in the viewport and sharp in the render, within reach of a wall."""
    cube = add_cube("Cube")
    add_modifier(cube, "SUBSURF", levels=2, render_levels=0)
    add_grid("Wall", 3, 3.0, (0.9, 0, 0), rotation_euler=(0, 1.5707963, 0))


@pytest.mark.parametrize("frames", [(), ("--frames", "1:2")])
def test_render_levels_are_tested_and_distinguished(tmp_path: Path, capsys, frames) -> None:
    smooth_cube_in_a_box()
    code, file = checked(tmp_path, *frames)
    assert code == 4 and all(pair["rendered"] for pair in file["pairs"])
    assert 'as rendered: object "Wall", face' in capsys.readouterr().out
    bpy.data.objects["Cube"].modifiers[0].render_levels = 2
    assert checked(tmp_path, *frames)[0] == 0


def test_large_render_levels_are_noted_and_tested_on_request(tmp_path: Path, capsys, monkeypatch) -> None:
    smooth_cube_in_a_box()
    bpy.data.objects["Wall"].location.x = 1.5
    bpy.data.objects["Cube"].modifiers[0].render_levels = 4
    assert guarded_evaluations.rendered_triangles(bpy.context) == 6 * 2 * 4**4
    monkeypatch.setattr(guarded_evaluations, "MAX_TRIANGLES", 3000)
    code, file = checked(tmp_path)
    assert code == 0 and file["triangles"] < 1000 and len(file["notes"]) == 1
    assert "render levels, of about 3,072 triangles, were not tested; --render tests them" in file["notes"][0]
    code, file = checked(tmp_path, "--render")
    assert code == 0 and file["triangles"] > 3000 and file["notes"] == []


def test_untested_objects_are_named(tmp_path: Path, capsys, monkeypatch) -> None:
    monkeypatch.setattr(strand_reading, "MAX_SEGMENTS", 0)
    add_modifier(add_cube("Cube"), "CURVE", object=add("Guide", bpy.data.curves.new("Guide", "CURVE"), (5, 0, 0)))
    for name, data in (
        ("Dust", bpy.data.pointclouds.new("Dust")),
        ("Smoke", bpy.data.volumes.new("Smoke")),
    ):
        add(name, data, (5, 0, 0))
    add_modifier(add_grid("Lawn", 2, 1.0, (9, 0, 0)), "PARTICLE_SYSTEM").particle_system.settings.type = "HAIR"
    code, file = checked(tmp_path)
    assert code == 0 and {(each["object"], each["reason"]) for each in file["untested"]} == {
        ("Guide", "helper curves"), ("Dust", "point clouds"), ("Smoke", "volumes"),
        ("Lawn", "particle hair of more than 0 segments"),
    }  # fmt: skip
    assert 'helper curves: 1 ("Guide")' in capsys.readouterr().out
    assert {each["reason"] for each in checked(tmp_path, "--object", "Cube")[1]["untested"]} == {"not named"}
