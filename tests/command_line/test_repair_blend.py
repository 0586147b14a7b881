# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv repair` on .blend files."""

import json

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from blend_fixtures.scenes.primitives import icosphere  # noqa: E402
from stiv.blender import check_scene  # noqa: E402
from stiv.blender.scripts.enabling import is_enabled  # noqa: E402
from stiv.command_line import program  # noqa: E402


@pytest.fixture(autouse=True)
def unregistered():
    """Leave no add-on registered that was not."""
    was_there = is_enabled()
    yield
    if is_enabled() and not was_there:
        import stiv_addon

        stiv_addon.unregister()


def save_balls(path, distance, size=0.7):
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    ball = icosphere(2)
    for name, offset, factor in (("One", 0.0, 1.0), ("Two", distance, size)):
        data = bpy.data.meshes.new(name)
        data.from_pydata((factor * ball.vertices).tolist(), [], [tuple(face) for face in ball.faces])
        ob = bpy.data.objects.new(name, data)
        ob.location.x = offset
        bpy.context.collection.objects.link(ob)
        ob.select_set(name == "One")
    bpy.ops.wm.save_as_mainfile(filepath=str(path))


def points(name):
    return np.array([v.co for v in bpy.data.objects[name].data.vertices])


def test_a_scene_is_repaired_and_saved(tmp_path, capfd):
    source, out, report = tmp_path / "balls ü.blend", tmp_path / "out.blend", tmp_path / "report.json"
    save_balls(source, 1.5)
    held = points("One")
    code = program.run(["repair", str(source), "-o", str(out), "--move", "Two", "--json", str(report)])
    assert code == 0
    output = capfd.readouterr().out
    assert "balls ü.blend: " in output and "mean deviation" in output
    bpy.ops.wm.open_mainfile(filepath=str(out))
    assert check_scene(bpy.context).pairs == ()
    assert np.array_equal(points("One"), held)
    assert [ob.name for ob in bpy.context.selected_objects] == ["One"]
    said = json.loads(report.read_text())
    assert (said["status"], said["pairs_left"]) == ("repaired", 0) and said["contracted"]


def test_what_cannot_be_repaired_ends_with_4_and_writes_nothing(tmp_path, capfd):
    source, out = tmp_path / "same.blend", tmp_path / "out.blend"
    save_balls(source, 0.0, 1.0)
    assert program.run(["repair", str(source), "-o", str(out)]) == 4
    assert 'object "One", face 0 - object "Two", face 0' in capfd.readouterr().out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["same.blend"]


def test_bad_names_and_outputs_end_with_2(tmp_path, capfd):
    source = tmp_path / "balls.blend"
    save_balls(source, 1.5)
    assert program.run(["repair", str(source), "-o", str(tmp_path / "out.obj")]) == 2
    assert "the output of a .blend must be a .blend" in capfd.readouterr().err
    assert program.run(["repair", str(source), "-o", str(tmp_path / "out.blend"), "--move", "Nobody"]) == 2
    assert 'no object "Nobody"' in capfd.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["balls.blend"]
