# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames of a scene, and intersections between them."""

import json
from pathlib import Path

import bpy
import pytest
from building import add, add_cube, add_grid, add_modifier, mesh

from stiv.blender.scripts.blend_files import save_blend
from stiv.blender.verify.frame_check import check_frames
from stiv.checks.findings import CROSSING, INTERSECTION
from stiv.command_line import program


def key_location(ob, **places) -> None:
    """Linear keyframes: `at_3=(x, y, z)` for frame 3."""
    for name, place in places.items():
        ob.location = place
        ob.keyframe_insert("location", frame=int(name.removeprefix("at_").replace("minus_", "-")))


def bullet_and_plate():
    """A small cube that is above the plate at frame 2 and below it at frame 3, free at both."""
    plate, bullet = add_grid("Pläte", 4, 2.0), add_cube("Bullet 1", (0.3, 0.2, 3.0), 0.1)
    key_location(bullet, at_1=(0.3, 0.2, 3), at_2=(0.3, 0.2, 1), at_3=(0.3, 0.2, -1), at_4=(0.3, 0.2, -3))
    return plate, bullet


def kinds(frames, **more):
    return [
        (f.kind, f.frame, f.to_frame, f.objects)
        for look in check_frames(bpy.context, frames, **more)
        for f in look.findings
    ]


def test_free_poses_with_a_crossing_between_them_are_found() -> None:
    bullet_and_plate()
    found = set(kinds(range(1, 5)))
    assert found == {(CROSSING, 2, 3, ("Bullet 1", "Pläte"))}
    assert kinds([1, 2]) == [] and kinds([3, 4]) == []


def test_the_crossing_is_found_backward_in_time_too() -> None:
    _, bullet = bullet_and_plate()
    key_location(bullet, at_1=(0.3, 0.2, -3), at_2=(0.3, 0.2, -1), at_3=(0.3, 0.2, 1), at_4=(0.3, 0.2, 3))
    assert set(kinds(range(1, 5))) == {(CROSSING, 2, 3, ("Bullet 1", "Pläte"))}


def test_the_time_of_a_crossing_is_that_of_the_first_contact() -> None:
    bullet_and_plate()
    looks = [look for look in check_frames(bpy.context, [2, 3]) if look.findings]
    (look,) = looks
    assert min(finding.time for finding in look.findings) == pytest.approx((1 - 0.1) / 2, abs=0.02)
    faces = {each for f in look.findings for each in (f.first, f.second) if each.object == "Pläte"}
    assert {each.kind for each in faces} == {"face"} and all(each.number in (5, 6, 9, 10) for each in faces)


def test_an_intersection_at_a_frame_is_reported_once_and_not_as_a_crossing() -> None:
    _, bullet = bullet_and_plate()
    key_location(bullet, at_3=(0.3, 0.2, 0.05))
    assert {(kind, frame) for kind, frame, *_ in kinds(range(2, 4))} == {(INTERSECTION, 3)}


def test_a_rotating_rigid_object_does_not_cross_itself() -> None:
    cube = add_cube("Cube")
    for frame, angle in ((1, 0.0), (2, 3.0)):
        cube.rotation_euler = (0, 0, angle)
        cube.keyframe_insert("rotation_euler", frame=frame)
    assert kinds([1, 2]) == []


def test_a_deforming_mesh_crosses_another_between_frames() -> None:
    add_grid("Plate", 4, 2.0)
    sheet = add_grid("Sheet", 4, 1.0, (0, 0, 1))
    sheet.shape_key_add(name="Basis")
    key = sheet.shape_key_add(name="Down")
    for point in key.data:
        point.co.z -= 2
    for frame, value in ((1, 0.0), (2, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    assert {(kind, objects) for kind, _, _, objects in kinds([1, 2])} == {(CROSSING, ("Plate", "Sheet"))}


def test_meshes_that_change_their_vertices_are_noted() -> None:
    add_grid("Plate", 4, 2.0)
    cube = add_cube("Cube", (0, 0, 5))
    array = add_modifier(cube, "ARRAY", relative_offset_displace=(0, 0, 1.5))
    for frame, count in ((1, 1), (2, 2)):
        array.count = count
        array.keyframe_insert("count", frame=frame)
    notes = [note for look in check_frames(bpy.context, [1, 2]) for note in look.notes]
    assert notes == ['between frames 1 and 2: object "Cube" changes its number of vertices or faces, and was left out']


def test_loose_edges_are_named() -> None:
    add_grid("Plate", 1, 2.0)
    wire = add("Wire", mesh("Wire", [(0.1, 0.3, 0), (0.2, -0.4, 0.01)], [], [(0, 1)]), (0, 0, 1))
    key_location(wire, at_1=(0, 0, 1), at_2=(0, 0, -1))
    looks = list(check_frames(bpy.context, [1, 2]))
    named = {str(each) for look in looks for f in look.findings for each in (f.first, f.second)}
    assert any(name.startswith('object "Wire", ') for name in named) and 'object "Plate", face 0' in named


def test_the_command_checks_frames_reports_and_pictures(tmp_path: Path, capsys) -> None:
    jsonschema, _ = pytest.importorskip("jsonschema"), pytest.importorskip("matplotlib")
    bullet_and_plate()
    scene, report = tmp_path / "bullet ü.blend", tmp_path / "report.json"
    save_blend(scene)
    arguments = ["check", str(scene), "--json", str(report), "--pictures", str(tmp_path / "pictures")]
    assert program.run([*arguments, "--frames", "1:4"]) == 4
    assert "between frames 2 and 3: object" in capsys.readouterr().out
    data = json.loads(report.read_text(encoding="utf-8"))
    jsonschema.validate(data, json.loads((Path(program.__file__).parents[1] / "schemas/check.schema.json").read_text()))
    (file,) = data["files"]
    assert file["frames"] == [1, 2, 3, 4] and {pair["kind"] for pair in file["pairs"]} == {"crossing"}
    assert Path(file["pictures"][0]).read_bytes().startswith(b"\x89PNG")
    assert program.run(["check", str(scene), "--frames", "3:4"]) == 0
    assert program.run(["check", str(scene)]) == 0
    assert program.run(["check", str(scene), "--frames", "1:2", "--object", "Nobody"]) == 2


def test_scripts_of_a_file_are_not_run(tmp_path: Path) -> None:
    add_cube("Cube")
    text = bpy.data.texts.new("harm.py")
    witness = tmp_path / "witness"
    text.write(f"open({str(witness)!r}, 'w').close()")
    text.use_module = True
    scene = tmp_path / "scene.blend"
    save_blend(scene)
    assert program.run(["check", str(scene)]) == 0
    assert not witness.exists()


@pytest.mark.parametrize("data", [b"", b"no scene", b"BLENDER-v402" + bytes(200)])
def test_a_file_in_another_format_ends_with_2(tmp_path: Path, capsys, data: bytes) -> None:
    scene = tmp_path / "broken ü.blend"
    scene.write_bytes(data)
    assert program.run(["check", str(scene)]) == 2
    assert "broken ü.blend: Blender cannot open it" in capsys.readouterr().err
