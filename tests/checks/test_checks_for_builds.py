# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv check` in a build: many files, baselines, JUnit, reports with a schema, pictures."""

import json
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from check_files import APART, CROSSING, CROSSING_TWICE, written
from json_schemas import read_valid, schema_of
from PIL import Image

from stiv.command_line import program


def test_each_of_several_files_has_its_own_result(tmp_path, capsys):
    files = [written(tmp_path / "a.obj", APART), written(tmp_path / "b ü.obj", CROSSING)]
    report = tmp_path / "report.json"
    assert program.run(["check", *files, "--json", str(report)]) == 4
    out = capsys.readouterr().out
    assert "a.obj: free of intersections" in out and "b ü.obj: 1 intersecting pair" in out
    data = read_valid(report, "check")
    assert [file["free"] for file in data["files"]] == [True, False]
    assert [file["file"] for file in data["files"]] == [Path(file).as_posix() for file in files]


def test_a_pattern_that_the_shell_did_not_expand_is_expanded(tmp_path):
    written(tmp_path / "a.obj", APART), written(tmp_path / "b.obj", CROSSING)
    assert program.run(["check", str(tmp_path / "*.obj")]) == 4
    assert program.run(["check", str(tmp_path / "a*.obj")]) == 0


def test_one_bad_file_ends_with_2_and_the_others_are_checked_and_reported(tmp_path, capsys):
    files = [written(tmp_path / "a.obj", "v 0 0 nan\n"), written(tmp_path / "b.obj", CROSSING)]
    report, junit = tmp_path / "report.json", tmp_path / "junit.xml"
    assert program.run(["check", *files, "--json", str(report), "--junit", str(junit)]) == 2
    assert "a.obj: vertex 0: coordinate is not finite" in capsys.readouterr().err
    data = read_valid(report, "check")
    assert data["files"][0]["error"] == "vertex 0: coordinate is not finite" and not data["files"][0]["free"]
    assert data["files"][1]["intersections"] == 1
    suites = ElementTree.parse(junit).getroot()
    assert [(suite.get("errors"), suite.get("failures")) for suite in suites] == [("1", "0"), ("0", "1")]


def test_only_the_named_objects_are_tested(tmp_path, capsys):
    mesh = written(tmp_path / "a.obj", CROSSING)
    assert program.run(["check", mesh, "--object", "flat"]) == 0
    assert program.run(["check", mesh, "--object", "flat", "--object", "upright ü"]) == 4
    assert program.run(["check", mesh, "--object", "nothing"]) == 2
    assert 'there is no object "nothing" in it; there are flat, upright ü' in capsys.readouterr().err


def test_a_mesh_has_no_frames(tmp_path, capsys):
    assert program.run(["check", written(tmp_path / "a.obj", APART), "--frames", "1:3"]) == 2
    assert "a mesh file has no frames" in capsys.readouterr().err


def test_known_intersections_are_accepted_until_they_grow(tmp_path, capsys):
    mesh, known = tmp_path / "a.obj", tmp_path / "known.json"
    arguments = ["check", written(mesh, CROSSING), "--baseline", str(known)]
    assert program.run([*arguments, "--write-baseline"]) == 0
    accepted = read_valid(known, "baseline")["accepted"]
    assert accepted == [{"file": "a.obj", "objects": ["flat", "upright ü"], "kind": "intersection", "pairs": 1}]
    assert program.run(arguments) == 0
    assert "1 pairs accepted by the baseline" in capsys.readouterr().out
    written(mesh, CROSSING_TWICE)
    assert program.run(arguments) == 4
    written(mesh, APART)
    assert program.run(arguments) == 0


def test_a_baseline_does_not_accept_other_objects(tmp_path):
    known = tmp_path / "known.json"
    program.run(["check", written(tmp_path / "a.obj", CROSSING), "--baseline", str(known), "--write-baseline"])
    renamed = written(tmp_path / "a.obj", CROSSING.replace("o flat", "o level"))
    assert program.run(["check", renamed, "--baseline", str(known)]) == 4


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "known.json: not JSON in UTF-8"),
        ("[" * 100_000, "known.json: "),
        ("{}", 'the field "schema" is not "stiv-baseline"'),
        ('{"schema": "stiv-baseline", "version": 9}', "version 9 is not supported"),
        ('{"schema": "stiv-baseline", "version": 1, "accepted": [3]}', 'accepted 0: "file" is not the name of a file'),
        (
            '{"schema": "stiv-baseline", "version": 1, "accepted": [{"file": "a", "objects": ["a"]}]}',
            'accepted 0: "objects" is not a list of two names',
        ),
    ],
)
def test_a_bad_baseline_ends_with_2(tmp_path, capsys, text, message):
    known = written(tmp_path / "known.json", text)
    assert program.run(["check", written(tmp_path / "a.obj", APART), "--baseline", known]) == 2
    assert message in capsys.readouterr().err


def test_junit_names_files_and_pairs_even_with_characters_that_xml_forbids(tmp_path):
    junit = tmp_path / "junit.xml"
    soup = tmp_path / "soup.npz"
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, -1], [0.2, 0.2, 1], [2, 2, 0]], float)
    names = np.array(["<flat> & \x01", "upright"])
    np.savez(soup, vertices=corners, triangles=np.arange(6).reshape(2, 3), object_names=names, triangle_object=[0, 1])
    assert program.run(["check", str(soup), "--junit", str(junit)]) == 4
    (suite,) = ElementTree.parse(junit).getroot()
    (case,) = suite.findall("testcase")
    assert (suite.get("name"), suite.get("tests"), suite.get("failures")) == (soup.as_posix(), "1", "1")
    assert case.find("failure").text == 'object "<flat> & \ufffd", triangle 0 - object "upright", triangle 0'


def test_a_picture_shows_both_objects_and_marks_the_faces(tmp_path):
    pytest.importorskip("matplotlib")
    report = tmp_path / "report.json"
    arguments = ["--pictures", str(tmp_path / "pictures"), "--json", str(report)]
    assert program.run(["check", written(tmp_path / "a.obj", CROSSING), *arguments]) == 4
    (name,) = read_valid(report, "check")["files"][0]["pictures"]
    with Image.open(name) as picture:
        pixels = np.asarray(picture.convert("RGB")).astype(int)
    red = (pixels[..., 0] > pixels[..., 1] + 60) & (pixels[..., 0] > pixels[..., 2] + 60)
    assert red.mean() > 0.02  # both triangles intersect, so both are marked completely
    assert (pixels == 255).all(axis=2).mean() > 0.2


def test_a_report_with_an_unknown_field_is_not_valid(tmp_path):
    report = tmp_path / "report.json"
    program.run(["check", written(tmp_path / "a.obj", APART), "--json", str(report)])
    data = json.loads(report.read_text()) | {"colour": 1}
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(data, schema_of("check"))
