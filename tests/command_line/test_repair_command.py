# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv repair` on mesh files: exit codes, report, outputs."""

import numpy as np
import pytest
from json_schemas import read_valid

import stiv
from blend_fixtures.scenes.primitives import icosphere
from blend_fixtures.scenes.tangled import hairpin
from stiv.command_line import program
from stiv.mesh_files import read_mesh, write_mesh


@pytest.fixture(scope="module")
def tube_obj(tmp_path_factory):
    """A tangled tube of quads and triangles with texture coordinates, comments and a material, as programs write it."""
    tube = hairpin(0.28, rings=24, sides=8)
    lines = ["# made for a test", "mtllib none.mtl", "o Tübe 1", "vt 0 0", "vt 1 0.5"]
    lines += [f"v {x:.9g} {y:.9g} {z:.9g} 0.5 0.25 1" for x, y, z in tube.positions]
    lines += ["usemtl skin", "s 1"]
    triangles = (tube.surface.triangles + 1).tolist()
    lines += [f"f {a}/1 {b}/2 {c}/1" for a, b, c in triangles]
    path = tmp_path_factory.mktemp("tubes") / "the tube.obj"
    path.write_text("\r\n".join(lines) + "\r\n", encoding="utf-8", newline="")
    return path


def free(path):
    mesh = read_mesh(path)
    return len(stiv.find_intersections(mesh.vertices, mesh.triangles)) == 0


def balls(distance, size=1.0):
    ball = icosphere(1)
    lines = []
    for name, start, offset, factor in (("one", 0, 0.0, 1.0), ("two", len(ball.vertices), distance, size)):
        lines += [f"o {name}"] + [f"v {factor * x + offset} {factor * y} {factor * z}" for x, y, z in ball.vertices]
        lines += ["f " + " ".join(str(k + start + 1) for k in face) for face in ball.faces]
    return "\n".join(lines) + "\n"


def test_a_tube_is_repaired_and_nothing_but_positions_changes(tube_obj, tmp_path, capsys):
    out, report = tmp_path / "out.obj", tmp_path / "report.json"
    assert not free(tube_obj)
    assert program.run(["repair", str(tube_obj), "-o", str(out), "--report", str(report)]) == 0
    assert free(out)
    before, after = tube_obj.read_bytes().split(b"\r\n"), out.read_bytes().split(b"\r\n")
    assert len(before) == len(after)
    for old, new in zip(before, after, strict=True):
        if old.startswith(b"v "):
            assert new.split()[4:] == old.split()[4:]
        else:
            assert new == old
    moved = read_mesh(out).vertices - read_mesh(tube_obj).vertices
    said = read_valid(report, "repair")
    assert (said["schema"], said["version"], said["status"], said["free"]) == ("stiv-repair", 1, "repaired", True)
    assert (said["file"], said["output"], said["pairs_left"]) == ("the tube.obj", "out.obj", 0)
    size = np.linalg.norm(np.ptp(read_mesh(tube_obj).vertices, axis=0))
    assert np.sqrt((moved**2).sum(axis=1).mean()) / size == pytest.approx(said["deviation"], rel=1e-3)
    assert "mean deviation" in capsys.readouterr().out


@pytest.mark.parametrize("suffix", [".ply", ".npz"])
def test_other_kinds_of_files_are_repaired_too(tube_obj, tmp_path, suffix):
    source, out, other = tmp_path / f"in{suffix}", tmp_path / f"out{suffix}", tmp_path / "other.obj"
    write_mesh(source, read_mesh(tube_obj))
    assert not free(source)
    assert program.run(["repair", str(source), "-o", str(out)]) == 0
    assert program.run(["repair", str(source), "-o", str(other)]) == 0
    assert free(out) and free(other)
    assert np.array_equal(read_mesh(out).vertices, read_mesh(other).vertices)


def test_a_time_limit_that_is_used_up_ends_with_4(tube_obj, tmp_path, capsys):
    out = tmp_path / "out.obj"
    assert program.run(["repair", str(tube_obj), "-o", str(out), "--time-limit", "1e-9"]) == 4
    assert "the time limit was too short" in capsys.readouterr().out
    assert not out.exists()


def test_what_is_free_is_copied(tmp_path, capsys):
    source, out = tmp_path / "a.obj", tmp_path / "b.obj"
    source.write_text(balls(3.0))
    assert program.run(["repair", str(source), "-o", str(out)]) == 0
    assert np.array_equal(read_mesh(out).vertices, read_mesh(source).vertices)
    assert "no intersections" in capsys.readouterr().out


def test_what_cannot_be_repaired_ends_with_4_and_writes_nothing(tmp_path, capsys):
    source, out, report = tmp_path / "a.obj", tmp_path / "b.obj", tmp_path / "report.json"
    source.write_text(balls(0.0))
    out.write_text("old content")
    assert program.run(["repair", str(source), "-o", str(out), "--json", str(report)]) == 4
    assert out.read_text() == "old content"
    said = read_valid(report, "repair")
    assert (said["status"], said["output"]) == ("refused", None)
    assert said["pairs"][0]["first"]["object"] == "one" and said["pairs"][0]["second"]["object"] == "two"
    assert said["pairs_left"] == said["pairs_before"] > 10
    output = capsys.readouterr().out
    assert "triangles coincide" in output and 'object "one", face 0 - object "two", face' in output
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.obj", "b.obj", "report.json"]


def test_only_the_named_object_moves(tmp_path, capsys):
    source, out = tmp_path / "a.obj", tmp_path / "b.obj"
    source.write_text(balls(1.5, 0.7))
    assert program.run(["repair", str(source), "-o", str(out), "--move", "two"]) == 0
    before, after = read_mesh(source).vertices, read_mesh(out).vertices
    half = len(before) // 2
    assert free(out)
    assert np.array_equal(before[:half].astype(np.float32), after[:half].astype(np.float32))
    assert not np.array_equal(before[half:].astype(np.float32), after[half:].astype(np.float32))
    assert program.run(["repair", str(source), "-o", str(out), "--move", "nobody"]) == 2
    assert 'no object "nobody"; the objects are' in capsys.readouterr().err


def test_seams_are_welded(tmp_path):
    ball = icosphere(2)
    corners = ball.vertices[np.array(ball.faces).ravel()]
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    lines += [f"f {3 * k + 1} {3 * k + 2} {3 * k + 3}" for k in range(len(ball.faces))]
    source, out = tmp_path / "seams.obj", tmp_path / "welded.obj"
    source.write_text("\n".join(lines))
    assert not free(source)
    assert program.run(["repair", "--weld", str(source), "-o", str(out)]) == 0
    assert free(out)
    assert read_mesh(out).vertices.shape == ball.vertices.shape


@pytest.mark.parametrize("name", ["out.stl", "out.blend"])
def test_unknown_outputs_are_refused_before_any_work(tube_obj, tmp_path, capsys, name):
    assert program.run(["repair", str(tube_obj), "-o", str(tmp_path / name)]) == 2
    assert "cannot write this format" in capsys.readouterr().err


def test_a_missing_output_is_wrong_usage(tube_obj, capsys):
    assert program.run(["repair", str(tube_obj)]) == 1
    assert "-o" in capsys.readouterr().err


def test_ctrl_c_ends_with_5_and_writes_nothing(tube_obj, tmp_path, monkeypatch):
    from stiv.command_line import repair_mesh

    def interrupt(*args, **kwargs):
        raise KeyboardInterrupt

    monkeypatch.setattr(repair_mesh.stiv, "repair", interrupt)
    assert program.run(["repair", str(tube_obj), "-o", str(tmp_path / "out.obj")]) == 5
    assert list(tmp_path.iterdir()) == []
