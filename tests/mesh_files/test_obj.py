# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading OBJ files."""

import numpy as np
import pytest

import stiv
from stiv.mesh_files import read_mesh

TWO_OBJECTS = """\
# comment
o First part
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
f 1/1/1 2/2/2 3//3 4
o Zweiter Körper
v 0 0 1 1.0
v 1 0 1
v 0 1 1
vt 0 0
usemtl grey
f -3 -2 -1
"""


def test_polygons_become_fans_with_their_objects(tmp_path):
    path = tmp_path / "zwei Körper.OBJ"
    path.write_text(TWO_OBJECTS, encoding="utf-8")
    mesh = read_mesh(path)
    assert mesh.vertices.shape == (7, 3)
    assert mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3], [4, 5, 6]]
    assert mesh.object_names == ("First part", "Zweiter Körper")
    assert mesh.triangle_object.tolist() == [0, 0, 1]


def test_faces_before_any_object_belong_to_one_named_after_the_file(tmp_path):
    path = tmp_path / "single.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    assert read_mesh(path).object_names == ("single",)


def test_a_file_without_faces_is_an_empty_mesh(tmp_path):
    path = tmp_path / "empty.obj"
    path.write_text("# nothing\n")
    mesh = read_mesh(path)
    assert mesh.vertices.shape == (0, 3) and mesh.triangles.shape == (0, 3)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("v 0 0\n", "line 1: a vertex needs three coordinates"),
        ("v 0 0 x\n", "line 1: could not convert"),
        ("v 0 0 nan\nf 1 1 1\n", "vertex 0: coordinate is not finite"),
        ("v 0 0 1e999\n", "vertex 0: coordinate is not finite"),
        ("v 0 0 0\nf 1 1\n", "line 2: a face needs three corners"),
        ("v 0 0 0\nf 0 1 1\n", "line 2: vertex index 0 is out of range"),
        ("v 0 0 0\nf -2 1 1\n", "line 2: vertex index -2 is out of range"),
        ("v 0 0 0\nf 1 1 2\n", "triangle 0: index out of range"),
        ("v 0 0 0\nf 1 1 99999999999999999999\n", "line 2: vertex index"),
        ("v 0 0 0\nf 1 1 a\n", "line 2: invalid literal"),
    ],
)
def test_bad_lines_are_named(tmp_path, text, message):
    path = tmp_path / "bad.obj"
    path.write_text(text)
    with pytest.raises(stiv.InputError, match=message) as caught:
        read_mesh(path)
    assert str(path) in str(caught.value)


def test_undecodable_bytes_are_an_error_or_ignored(tmp_path):
    path = tmp_path / "noise.obj"
    path.write_bytes(np.random.default_rng(1).bytes(5000))
    try:
        read_mesh(path)
    except stiv.InputError as error:
        assert "noise.obj" in str(error)
