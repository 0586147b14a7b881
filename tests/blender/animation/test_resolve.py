# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv resolve`: intersecting animations are corrected; checks read the written file back."""

import json
from pathlib import Path

import bpy
import numpy as np
import pytest
from building import add, add_cube, add_grid, add_modifier, mesh
from torn_sheets import CROSSING, PARTING, add_key, cutting_faces, rig_halves, torn_sheet

from stiv.blender.scripts.blend_files import open_blend, save_blend
from stiv.blender.verify.frame_check import check_frames, set_frame
from stiv.command_line import program


def key(ob, path: str, values) -> None:
    """Linear keyframes from frame 1 on."""
    for frame, value in enumerate(values, 1):
        setattr(ob, path, value)
        ob.keyframe_insert(path, frame=frame)


def resolved(folder: Path, last: int, *options: str, code: int = 0) -> dict:
    """Saves the open scene, resolves it, opens the result, and gives the report."""
    scene, out, report = folder / "scene ü.blend", folder / "out.blend", folder / "report.json"
    save_blend(scene)
    arguments = ["resolve", str(scene), "--frames", f"1:{last}", "-o", str(out), "--report", str(report), *options]
    assert program.run(arguments) == code
    if code == 0:
        open_blend(out)
    return json.loads(report.read_text(encoding="utf-8")) if report.exists() else {}


def findings(last: int):
    return [str(found) for look in check_frames(bpy.context, range(1, last + 1)) for found in look.findings]


def positions(name: str, frame: float) -> np.ndarray:
    set_frame(bpy.context.scene, frame)
    shown = bpy.data.objects[name].evaluated_get(bpy.context.evaluated_depsgraph_get())
    return np.array([shown.matrix_world @ vertex.co for vertex in shown.data.vertices])


def test_an_object_that_tunnels_through_a_plate_stays_before_it(tmp_path: Path) -> None:
    add_grid("Plate", 4, 2.0)
    key(add_cube("Bullet ü", size=0.1), "location", [(0.3, 0.2, z) for z in (2, 1, -1, -1.5, 0.5, 1)])
    assert findings(6)  # it crosses between frames 2 and 3, and back between 4 and 5
    report = resolved(tmp_path, 6)
    jsonschema = pytest.importorskip("jsonschema")
    schema = Path(program.__file__).parents[1] / "schemas/resolve.schema.json"
    jsonschema.validate(report, json.loads(schema.read_text()))
    assert findings(6) == [] and report["free"]
    assert [frame["frame"] for frame in report["frames"]] == [1, 2, 3, 4, 5, 6]
    assert all(frame["reversible"] for frame in report["frames"])
    assert all((positions("Bullet ü", frame)[:, 2] > 0).all() for frame in range(1, 7))
    np.testing.assert_allclose(positions("Bullet ü", 2)[:, 2].mean(), 1, atol=1e-6)  # as animated where it is free
    np.testing.assert_allclose(positions("Bullet ü", 6)[:, 2].mean(), 1, atol=1e-5)  # and again when it comes back
    assert positions("Bullet ü", 3)[:, 2].min() < 0.1


def test_a_sheet_that_changes_its_shape_is_written_as_shape_keys(tmp_path: Path) -> None:
    add_grid("Plate", 3, 2.0)
    sheet = add_grid("Sheet", 6, 1.0, (0.05, 0.02, 0.5), rotation_euler=(0, 0, 0.2), scale=(1, 0.8, 1))
    sheet.shape_key_add(name="Basis")
    down = sheet.shape_key_add(name="Down")
    for point in down.data:
        point.co.z -= 1.2 * np.exp(-3 * (point.co.x**2 + point.co.y**2))
    key(down, "value", [0, 0.3, 0.6, 1.0, 0.2])
    wanted = positions("Sheet", 2)
    assert findings(5)
    resolved(tmp_path, 5)
    assert findings(5) == []
    np.testing.assert_allclose(positions("Sheet", 2), wanted, atol=1e-5)
    assert (positions("Sheet", 4)[:, 2] > 0).all() and positions("Sheet", 4)[:, 2].min() < 0.15
    assert len(bpy.data.objects["Sheet"].data.shape_keys.key_blocks) >= 5


def test_connected_objects_stay_together(tmp_path: Path) -> None:
    add_grid("Plate", 4, 2.0)
    parent = add("Parent", None)
    for name, place in (("One", (-0.5, 0, 0)), ("Two", (0.5, 0, 0.4))):
        add_cube(name, place, 0.1).parent = parent
    key(parent, "location", [(0, 0, 1), (0, 0, 0.5), (0, 0, -0.5)])
    bpy.context.view_layer.update()
    resolved(tmp_path, 3)
    assert findings(3) == []
    one, two = positions("One", 3), positions("Two", 3)
    assert one[:, 2].min() > 0 and one[:, 2].min() < 0.2
    np.testing.assert_allclose(np.linalg.norm(one.mean(axis=0) - two.mean(axis=0)), np.hypot(1, 0.4), atol=1e-5)


def test_a_rotating_object_is_resolved(tmp_path: Path) -> None:
    bar = add("Bar", mesh("Bar", [(-1, 0, 0), (1, 0, 0), (1, 0.1, 0), (-1, 0.1, 0)], [(0, 1, 2, 3)]), (0, 0, 3))
    key(bar, "rotation_euler", [(0, 0, angle) for angle in (0, 1, 2, 3, 4, 5)])
    wanted = positions("Bar", 5)
    resolved(tmp_path, 6)
    np.testing.assert_allclose(positions("Bar", 5), wanted, atol=1e-5)


def test_held_objects_keep_their_animation_and_others_yield(tmp_path: Path) -> None:
    key(add_cube("Pusher", size=0.5), "location", [(x, 0, 0) for x in (-3, -2, -1, 0)])
    key(add_cube("Pushed", size=0.5), "location", [(0, 0.1, 0.01 * k) for k in range(4)])
    assert findings(4)
    report = resolved(tmp_path, 4, "--hold", "Pusher")
    assert findings(4) == []
    assert report["frames"][-1]["status"] == "corrected"
    np.testing.assert_allclose(positions("Pusher", 4).mean(axis=0), 0, atol=1e-5)
    assert np.abs(positions("Pushed", 4).mean(axis=0)).max() > 0.5


def test_an_animation_without_contact_is_unchanged(tmp_path: Path) -> None:
    add_grid("Plate", 4, 2.0)
    key(add_cube("Cube", size=0.1), "location", [(0, 0, 2), (0, 0, 1)])
    report = resolved(tmp_path, 2)
    assert [frame["status"] for frame in report["frames"]] == ["start", "reached"]


def test_a_first_frame_that_intersects_ends_with_4_and_writes_nothing(tmp_path: Path, capsys) -> None:
    add_grid("Plate", 4, 2.0)
    key(add_cube("Cube", size=0.1), "location", [(0.3, 0.2, 0), (0, 0, 1)])
    resolved(tmp_path, 2, code=4)
    assert "the first frame" in capsys.readouterr().out
    assert not (tmp_path / "out.blend").exists()


@pytest.mark.parametrize("case", ["hold", "array", "text"])
def test_unsupported_animations_are_refused_by_name(tmp_path: Path, capsys, case: str) -> None:
    cube = add_cube("Cube", size=0.1)
    key(cube, "location", [(0, 0, 2), (0, 0, 1)])
    if case == "array":
        key(add_modifier(cube, "ARRAY"), "count", [1, 2])
    if case == "text":
        curve = add("Words", bpy.data.curves.new("Words", "FONT"), (3, 0, 0))
        curve.data.body = "a"
        key(curve, "scale", [(1, 1, 1), (2, 2, 2)])
    resolved(tmp_path, 2, *(["--hold", "Nobody"] if case == "hold" else []), code=2)
    said = {
        "hold": "Nobody: does not move",
        "array": "Cube: other vertices at frame 2",
        "text": "Words: a text that deforms",
    }
    assert said[case] in capsys.readouterr().err
    assert not (tmp_path / "out.blend").exists()


def test_seams_of_a_shape_stay_closed(tmp_path: Path) -> None:
    add_grid("Plate", 1, 4.0, (0, 0, 0.5))
    whole = add_grid("Whole", 4)
    places = np.array([tuple(whole.data.vertices[k].co) for face in whole.data.polygons for k in face.vertices])
    bpy.data.objects.remove(whole)
    ob = add("Unwelded", mesh("Unwelded", places, np.arange(64).reshape(16, 4).tolist()))
    ob.shape_key_add(name="Basis")
    bulge = ob.shape_key_add(name="Bulge")
    bulge.data.foreach_set("co", (places + np.exp(-3 * (places**2).sum(axis=1))[:, None] * (0, 0, 1)).ravel())
    key(bulge, "value", [0.0, 0.4, 0.8, 1.0])
    assert findings(4)
    resolved(tmp_path, 4)
    assert findings(4) == []
    _, same = np.unique(places, axis=0, return_inverse=True)
    for frame in range(1, 5):
        assert len(np.unique(positions("Unwelded", frame), axis=0)) == same.max() + 1 == 25


@pytest.mark.parametrize("moved", [CROSSING, PARTING])
def test_a_seam_that_opens_during_the_animation_is_named_with_the_way_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], moved: dict
) -> None:
    """Its faces are tested, so nothing has to be said about them at the end: the touching ones are refused."""
    sheet = torn_sheet()
    key(add_key(sheet, "Open", moved), "value", [0.0, 0.0, 0.5, 1.0])
    set_frame(bpy.context.scene, 4)
    assert cutting_faces(sheet) == (2 if moved is CROSSING else 0)
    resolved(tmp_path, 4, code=4)
    said = "Sheet: a seam opens during the animation, and its faces touch here; use Merge by Distance"
    assert said in capsys.readouterr().out and not (tmp_path / "out.blend").exists()
    add_cube("Inside", (0.5, 0.5, 0), 0.2)
    resolved(tmp_path, 4, code=4)
    assert said not in capsys.readouterr().out  # that is not the only reason


def test_keyframes_that_cross_a_torn_seam_are_corrected_until_nothing_cuts(tmp_path: Path) -> None:
    """Bones that move the copies apart: faces there are tested against each other, unlike in an edit."""
    sheet = torn_sheet()
    rig = rig_halves(sheet)
    bone = rig.pose.bones["B"]
    bone.rotation_mode = "XYZ"
    for frame, x, z, angle in ((1, 0.2, 0, 0), (4, 0.2, 0, 0), (5, 0, 0, 0.4), (6, -0.1, 0, 0.4), (7, 0.2, 0, 0)):
        bone.location, bone.rotation_euler = (x, 0, z), (angle, 0, 0)
        bone.keyframe_insert("location", frame=frame)
        bone.keyframe_insert("rotation_euler", frame=frame)
    assert any("Sheet" in each for each in findings(7))
    resolved(tmp_path, 7, "--write", "rig", "--joint-region", "0")
    assert findings(7) == []
