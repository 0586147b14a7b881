# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv resolve --write rig`: clips are corrected by keyframes; checks read the written file back."""

import json
from pathlib import Path

import bmesh
import bpy
import numpy as np
import pytest
from building import add_cube, add_grid
from mathutils import Matrix

from blend_fixtures.moving_characters import make_clip
from stiv.blender.scene.animation_curves import own_curves
from stiv.blender.scripts.blend_files import open_blend, save_blend
from stiv.blender.verify.frame_check import check_frames, set_frame
from stiv.command_line import program

LAST = {"walk": 25, "pick": 49}


def resolved(folder: Path, *options: str, code: int = 0) -> dict:
    """Saves the open scene, resolves it, opens the result, and gives the report."""
    scene, out, report = folder / "scene ü.blend", folder / "out.blend", folder / "report.json"
    save_blend(scene)
    arguments = ["resolve", str(scene), "--frames", "scene", "--write", "rig", "-o", str(out), "--report", str(report)]
    assert program.run([*arguments, *options]) == code
    assert out.exists() == (code == 0)
    if code == 0:
        open_blend(out)
    return json.loads(report.read_text(encoding="utf-8")) if report.exists() else {}


def findings(last: int, step: float = 1.0) -> list[str]:
    frames = np.arange(1, last + step / 2, step).tolist()
    return [str(found) for look in check_frames(bpy.context, frames) for found in look.findings]


def shapes(last: int) -> np.ndarray:
    """World positions of all meshes at whole frames, (F, n, 3)."""
    found = []
    for frame in range(1, last + 1):
        set_frame(bpy.context.scene, frame)
        graph = bpy.context.evaluated_depsgraph_get()
        shown = [ob.evaluated_get(graph) for ob in bpy.context.scene.objects if ob.type == "MESH"]
        found.append([tuple(each.matrix_world @ vertex.co) for each in shown for vertex in each.data.vertices])
    return np.array(found)


def bends(last: int) -> np.ndarray:
    """Rotation of each bone relative to its parent, (F, b, 3, 3)."""
    found = []
    for frame in range(1, last + 1):
        set_frame(bpy.context.scene, frame)
        bones = [bone for ob in bpy.context.scene.objects if ob.pose for bone in ob.pose.bones]
        found.append([np.array(bone.matrix_basis.to_3x3().normalized()) for bone in bones])
    return np.array(found)


def contents() -> list[tuple[str, ...]]:
    """Objects with their meshes, modifiers, parents and actions, by name."""
    return [
        (ob.name, *(block.name for block in (ob.data, ob.parent) if block is not None), *ob.modifiers.keys(),
         *(() if ob.animation_data is None else (ob.animation_data.action.name,)))
        for ob in bpy.context.scene.objects
    ]  # fmt: skip


def largest_acceleration(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(points, n=2, axis=0), axis=2).max())


def joint_acceleration(rotations: np.ndarray) -> float:
    """Largest change of the rotation from frame to frame, of rotations (F, b, 3, 3)."""
    steps = np.einsum("fbij,fbkj->fbik", rotations[1:], rotations[:-1])
    skew = np.stack([steps[..., 2, 1] - steps[..., 1, 2], steps[..., 0, 2] - steps[..., 2, 0],
                     steps[..., 1, 0] - steps[..., 0, 1]], axis=-1) / 2  # fmt: skip
    return float(np.linalg.norm(np.diff(skew, axis=0), axis=2).max())


@pytest.mark.shared
@pytest.mark.parametrize("name", ["walk", "pick"])
def test_a_clip_is_corrected_by_its_keyframes(tmp_path: Path, name: str) -> None:
    make_clip(name)
    last = LAST[name]
    before, poses = shapes(last), bends(last)
    before_contents = contents()
    assert findings(last)
    report = resolved(tmp_path, "--joint-region", "0")
    assert findings(last) == [] and findings(last, 0.25) == []  # what plays between frames, too
    after = shapes(last)
    assert contents() == before_contents
    assert largest_acceleration(after) <= 1.1 * largest_acceleration(before)
    assert joint_acceleration(bends(last)) <= 1.1 * joint_acceleration(poses)
    cosines = (np.einsum("fbij,fbij->fb", poses, bends(last)) - 1) / 2
    turns = np.degrees(np.arccos(np.clip(cosines, -1, 1)))
    assert 0 < turns.mean() <= 3
    unchanged = [frame["frame"] - 1 for frame in report["frames"] if frame["status"] == "unchanged"]
    np.testing.assert_allclose(after[unchanged], before[unchanged], atol=1e-6)
    assert report["free"] and report["acceleration"] <= 1.1
    assert {frame["status"] for frame in report["frames"]} <= {"corrected", "unchanged"}
    jsonschema = pytest.importorskip("jsonschema")
    schema = Path(program.__file__).parents[1] / "schemas/resolve_rig.schema.json"
    jsonschema.validate(report, json.loads(schema.read_text()))


def split_meshes() -> None:
    """Give every face vertices of its own; at their seams, faces touch at all frames."""
    for ob in [each for each in bpy.context.scene.objects if each.type == "MESH"]:
        edited = bmesh.new()
        edited.from_mesh(ob.data)
        bmesh.ops.split_edges(edited, edges=edited.edges)
        edited.to_mesh(ob.data)
        edited.free()


@pytest.mark.shared
@pytest.mark.parametrize("region", ["0", "1.2"])
def test_a_split_mesh_is_corrected_like_the_whole_one(tmp_path: Path, region: str) -> None:
    turned = []
    for is_split in (False, True):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        make_clip("walk")
        if is_split:
            split_meshes()
        (folder := tmp_path / str(is_split)).mkdir()
        before = bends(25)
        assert resolved(folder, "--joint-region", region)["free"]
        assert region != "0" or findings(25) == []
        assert np.abs(bends(25) - before).max() > 0.01
        turned.append(bends(25))
    np.testing.assert_allclose(turned[1], turned[0], atol=0.01)


def test_only_the_chosen_bones_change_and_no_more_than_allowed(tmp_path: Path) -> None:
    make_clip("walk")
    before = bends(25)
    names = [bone.name for bone in bpy.data.objects["Rig"].pose.bones]
    resolved(tmp_path, "--joint-region", "0", "--bone", "Forearm.*=15", "--bone", "Arm.L=2")
    assert findings(25) == []
    cosines = (np.einsum("fbij,fbij->fb", before, bends(25)) - 1) / 2
    most = dict(zip(names, np.degrees(np.arccos(np.clip(cosines, -1, 1))).max(axis=0).tolist(), strict=True))
    assert {name for name, turn in most.items() if turn > 0.1} <= {"Forearm.L", "Forearm.R", "Arm.L"}
    assert most["Forearm.L"] > 1 and most["Arm.L"] <= 2 * 3**0.5 + 0.1


def test_the_target_of_an_inverse_kinematics_is_corrected_and_the_constraint_stays(tmp_path: Path) -> None:
    make_clip("walk")
    rig = bpy.data.objects["Rig"]
    rig.animation_data_clear()
    for bone in rig.pose.bones:
        bone.rotation_euler = (0, 0, 0)
    hand = bpy.data.objects.new("Hand", None)
    bpy.context.collection.objects.link(hand)
    places = [0.5 - 0.5 * np.cos(2 * np.pi * k / 24) for k in range(25)]
    key(hand, "location", [(1.05 - 0.76 * along, -0.15, 0.5) for along in places])
    reach = rig.pose.bones["Forearm.L"].constraints.new("IK")
    reach.target, reach.chain_count = hand, 2
    before = bends(25)
    assert findings(25)
    report = resolved(tmp_path, "--joint-region", "0")
    assert findings(25) == [] and report["free"]
    np.testing.assert_array_equal(bends(25), before)  # of the bones' own channels
    rig = bpy.data.objects["Rig"]
    assert rig.animation_data is None and rig.pose.bones["Forearm.L"].constraints[0].target.name == "Hand"


def key(ob, path: str, values) -> None:
    """Linear keyframes from frame 1 on."""
    for frame, value in enumerate(values, 1):
        setattr(ob, path, value)
        ob.keyframe_insert(path, frame=frame)
    for curve in own_curves(ob):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"
    bpy.context.scene.frame_end = len(values)


def test_an_object_is_corrected_by_its_own_keyframes_and_keeps_its_parent(tmp_path: Path) -> None:
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    ball = add_cube("Ball", size=0.2)
    ball.parent = parent
    add_grid("Plate", 4, 2.0)
    heights = [0.6 - 0.5 * np.sin(0.1 * np.pi * k) ** 2 for k in range(11)]
    key(ball, "location", [(0.1 * k, 0.03, z) for k, z in enumerate(heights)])
    assert findings(11)
    report = resolved(tmp_path, "--max-move", "0.3", "--acceleration", "1.5")
    assert findings(11) == [] and bpy.data.objects["Ball"].parent.name == "Parent"
    assert report["acceleration"] <= 1.5


def test_frames_that_bones_cannot_correct_are_named_and_nothing_is_written(tmp_path: Path, capsys) -> None:
    add_grid("Plate", 4, 2.0)
    key(add_cube("Bullet", size=0.1), "location", [(0.3, 0.2, z) for z in (2, 1, -1, -2, -3)])
    report = resolved(tmp_path, code=4)
    assert "bones alone cannot correct frames 2, 3; nothing was written" in capsys.readouterr().out
    assert not report["free"] and [f["frame"] for f in report["frames"] if f["status"] == "failed"] == [2, 3]


def swinging_bar() -> None:
    """A bar of 5 segments on a bone swings down by 16 degrees and touches a box."""
    data = bpy.data.armatures.new("Rig")
    rig = bpy.data.objects.new("Rig", data)
    bpy.context.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = data.edit_bones.new("Bar")
    bone.head, bone.tail = (0, 0, 0), (1, 0, 0)
    bpy.ops.object.mode_set(mode="OBJECT")
    bar = add_grid("Bar", 8, 0.5, (0.5, 0, 0))
    bar.data.transform(Matrix.Translation((0.5, 0, 0)) @ Matrix.Diagonal((1, 0.3, 1, 1)))
    bar.location = (0, 0, 0)
    bar.vertex_groups.new(name="Bar").add(range(len(bar.data.vertices)), 1, "REPLACE")
    bar.parent = rig
    bar.modifiers.new("Armature", "ARMATURE").object = rig
    add_cube("Box", (0.8, 0, -0.4), 0.1, scale=(1, 3, 2.5))
    rig.pose.bones["Bar"].rotation_mode = "XYZ"
    for frame in range(1, 14):
        rig.pose.bones["Bar"].rotation_euler = (0, 0, 0)
        rig.pose.bones["Bar"].rotation_euler[0] = np.radians(-8 * (1 - np.cos((frame - 1) * np.pi / 6)))
        rig.pose.bones["Bar"].keyframe_insert("rotation_euler", frame=frame)
    bpy.context.scene.frame_end = 13


@pytest.mark.shared
@pytest.mark.parametrize("is_split", [False, True])
def test_frames_beyond_the_bones_get_corrective_keys_if_allowed(tmp_path: Path, capsys, is_split: bool) -> None:
    swinging_bar()
    if is_split:
        split_meshes()
    assert findings(13)
    before = bends(13)
    resolved(tmp_path, "--max-turn", "1", "--joint-region", "0", code=4)
    assert "bones alone cannot correct frames" in capsys.readouterr().out
    report = resolved(tmp_path, "--max-turn", "1", "--joint-region", "0", "--allow-shapes")
    assert findings(13) == [] and findings(13, 0.125) == []
    keys = bpy.data.objects["Bar"].data.shape_keys.key_blocks
    shaped = [frame["frame"] for frame in report["frames"] if frame["status"] == "shaped"]
    assert 7 in shaped and {f"Corrective {frame}" for frame in shaped} <= {*keys.keys()}
    cosines = (np.einsum("fbij,fbij->fb", before, bends(13)) - 1) / 2
    assert 0.5 < np.degrees(np.arccos(np.clip(cosines, -1, 1))).max() <= 1.01
    rest, bent = shapes(13)[[0, 6]]
    same = np.unique(np.round(rest, 5), axis=0, return_inverse=True)[1].reshape(-1)
    first = np.unique(same, return_index=True)[1][same]
    np.testing.assert_allclose(bent, bent[first], atol=1e-6)  # copies stay together
    set_frame(bpy.context.scene, 1)
    assert all(key.value == 0 for key in keys if key.name.startswith("Corrective"))


@pytest.mark.shared
def test_keyframes_elsewhere_keep_their_values_and_shapes(tmp_path: Path) -> None:
    make_clip("reach")
    rig = bpy.data.objects["Rig"]
    bpy.context.scene.frame_start = 3
    curves = {(c.data_path, c.array_index): c for c in own_curves(rig)}
    times = [*np.arange(1, 6.01, 0.25), *np.arange(33, 37.01, 0.25)]
    before = {name: [curve.evaluate(time) for time in times] for name, curve in curves.items()}
    rig.animation_data.action.use_fake_user = True
    other = bpy.data.objects.new("Other", None)
    bpy.context.collection.objects.link(other)
    other.animation_data_create().action = rig.animation_data.action
    resolved(tmp_path, "--joint-region", "0")
    after = {(c.data_path, c.array_index): c for c in own_curves(bpy.data.objects["Rig"])}
    assert set(after) == set(before)
    for name, values in before.items():
        np.testing.assert_allclose([after[name].evaluate(time) for time in times], values, atol=1e-5)
    untouched = bpy.data.objects["Other"].animation_data.action
    assert untouched != bpy.data.objects["Rig"].animation_data.action


def pushed_down(rig) -> None:
    track = rig.animation_data.nla_tracks.new()
    track.strips.new("Walk", 1, rig.animation_data.action)
    rig.animation_data.action = None


def repeated(rig) -> None:
    for curve in own_curves(rig):
        curve.modifiers.new("CYCLES")


BAD = {
    "no keyframes move a bone or an object; use --write shapes": lambda rig: rig.animation_data_clear(),
    "Rig: NLA strips move it; bake them to an action": pushed_down,
    "its curve has a modifier; bake the action": repeated,
    "Rig: it shows its rest position; choose Pose Position": lambda rig: setattr(rig.data, "pose_position", "REST"),
    "Rig: it deforms no visible mesh; parent one to it": lambda rig: bpy.data.objects.remove(bpy.data.objects["Bar"]),
    "Rig: it has no keyframes in frames 100 to 110": lambda rig: rig.users_scene[0].__setattr__("frame_start", 100),
}


@pytest.mark.parametrize("message", BAD)
def test_bad_input_is_refused_by_name(tmp_path: Path, capsys, message: str) -> None:
    swinging_bar()
    BAD[message](bpy.data.objects["Rig"])
    bpy.context.scene.frame_end = max(bpy.context.scene.frame_end, bpy.context.scene.frame_start + 10)
    resolved(tmp_path, code=2)
    text = capsys.readouterr().err
    assert message in text and len(text.rstrip().rsplit("blend: ", 1)[1]) <= 80
    assert not (tmp_path / "out.blend").exists()


@pytest.mark.parametrize(("options", "message"), [
    (("--bone", "Tail*"), "Tail*: no keyframes move a bone or object of this name"),
    (("--hold", "Ghost"), "Ghost: there is no object of this name; remove it from --hold"),
    (("--frames", "1:13:2"), "--write rig needs at least two frames in steps of 1"),
])  # fmt: skip
def test_bad_options_are_refused_by_name(tmp_path: Path, capsys, options, message: str) -> None:
    swinging_bar()
    resolved(tmp_path, *options, code=2)
    assert message in capsys.readouterr().err


def test_a_linked_rig_without_an_override_is_refused(tmp_path: Path, capsys) -> None:
    swinging_bar()
    library = tmp_path / "library.blend"
    save_blend(library)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(str(library), link=True) as (_, linked):
        linked.objects = ["Rig", "Bar", "Box"]
    for ob in linked.objects:
        bpy.context.collection.objects.link(ob)
    bpy.context.scene.frame_end = 13
    resolved(tmp_path, code=2)
    assert "Rig: it is linked; make a library override of it" in capsys.readouterr().err
