# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading PLY files, ascii and binary."""

import struct

import numpy as np
import pytest

import stiv
from stiv.mesh_files import read_mesh

VERTICES = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.5), (0.25, 0.5, 2.0)]
FACES = [(0, 1, 2, 3), (0, 1, 4), (1, 2, 3, 4, 0)]
TRIANGLES = [[0, 1, 2], [0, 2, 3], [0, 1, 4], [1, 2, 3], [1, 3, 4], [1, 4, 0]]


def header(kind, faces=FACES):
    return (
        f"ply\nformat {kind} 1.0\ncomment made for a test\nelement vertex {len(VERTICES)}\nproperty float x\n"
        "property float y\nproperty float z\nproperty uchar red\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nproperty float quality\nend_header\n"
    ).encode()


def binary(order, faces=FACES):
    body = b"".join(struct.pack(order + "fffB", *vertex, 7) for vertex in VERTICES)
    rows = [struct.pack(f"{order}B{len(face)}if", len(face), *face, 0.5) for face in faces]
    return header({"<": "binary_little_endian", ">": "binary_big_endian"}[order], faces) + body + b"".join(rows)


def ascii_text(faces=FACES):
    lines = ["{} {} {} 7".format(*vertex) for vertex in VERTICES]
    lines += [" ".join(map(str, (len(face), *face, 0.5))) for face in faces]
    return header("ascii", faces) + "\n".join(lines).encode() + b"\n"


@pytest.mark.parametrize("data", [binary("<"), binary(">"), ascii_text()], ids=["little", "big", "ascii"])
def test_all_encodings_give_the_same_mesh(tmp_path, data):
    path = tmp_path / "five points.ply"
    path.write_bytes(data)
    mesh = read_mesh(path)
    assert np.allclose(mesh.vertices, VERTICES)
    assert mesh.triangles.tolist() == TRIANGLES
    assert mesh.object_names == ("five points",)


def test_rows_of_one_length_are_read_as_a_table(tmp_path):
    path = tmp_path / "triangles.ply"
    path.write_bytes(binary("<", [(0, 1, 2), (2, 3, 4), (4, 0, 1)]))
    assert read_mesh(path).triangles.tolist() == [[0, 1, 2], [2, 3, 4], [4, 0, 1]]


@pytest.mark.parametrize("make", [lambda: binary("<"), lambda: binary(">"), ascii_text])
def test_every_truncation_is_an_error(tmp_path, make):
    data = make()
    path = tmp_path / "cut.ply"
    for length in range(0, len(data) - 5, 3):
        path.write_bytes(data[:length])
        with pytest.raises(stiv.InputError, match=r"cut\.ply"):
            read_mesh(path)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (b"element vertex 5", b"element vertex 2000000000", "announces 2000000000 rows"),
        (b"element vertex 5", b"element vertex -5", "line 4 of its header"),
        (b"element face 3", b"element face 2000000000", "announces 2000000000 rows"),
        (b"property float x", b"property quaternion x", "line 5 of its header"),
        (b"property float x", b"property float w", 'the property "x" is missing'),
        (b"property float y", b"property float x", "two properties have the same name"),
        (b"vertex_indices", b"vertex_incides", 'the list property "vertex_indices" is missing'),
        (b"binary_little_endian", b"binary_middle_endian", "line 2 of its header"),
    ],
)
def test_bad_headers_are_refused_before_anything_is_allocated(tmp_path, old, new, message):
    path = tmp_path / "bad.ply"
    path.write_bytes(binary("<").replace(old, new))
    with pytest.raises(stiv.InputError, match=message):
        read_mesh(path)


def test_an_index_out_of_range_is_named(tmp_path):
    path = tmp_path / "bad.ply"
    path.write_bytes(binary("<", [(0, 1, 2), (0, 1, 5)]))
    with pytest.raises(stiv.InputError, match="triangle 1: index out of range"):
        read_mesh(path)
