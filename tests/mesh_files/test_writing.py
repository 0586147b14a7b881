# SPDX-License-Identifier: GPL-3.0-or-later
"""Written mesh files, read back, and copies with other positions."""

import struct

import numpy as np
import pytest

import stiv
from stiv.mesh_files import read_mesh, require_writer, welded_mesh, write_mesh, write_repositioned

OBJ = """\
o first
v 0.1 0.2 0.3
v 1 0 0
v 1 1e-7 0.7
v 0 1 0
v 0.5 0.5 2
f 1 2 3 4
f 1 2 5
o second ö
v 9 9 9
v 8 9 9
v 9 8 9.000000001
f 6 7 8
f 3 4 5 6 7
"""


@pytest.fixture
def mesh(tmp_path):
    (tmp_path / "in.obj").write_text(OBJ, encoding="utf-8")
    return read_mesh(tmp_path / "in.obj")


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".npz"])
def test_written_meshes_are_read_back_exactly(tmp_path, mesh, suffix):
    path = tmp_path / f"out ü{suffix}"
    write_mesh(path, mesh)
    back = read_mesh(path)
    assert np.array_equal(back.vertices, mesh.vertices)
    assert np.array_equal(back.triangles, mesh.triangles)
    if suffix != ".npz":
        assert np.array_equal(back.corners, mesh.corners) and np.array_equal(back.counts, mesh.counts)
    if suffix != ".ply":
        assert back.object_names == mesh.object_names
        assert np.array_equal(back.triangle_object, mesh.triangle_object)


def test_an_unknown_suffix_is_refused(tmp_path):
    with pytest.raises(stiv.InputError, match="cannot write this format"):
        require_writer(tmp_path / "a.stl")


def test_welding_keeps_polygons_and_drops_degenerate_ones(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0\nv -0 1 0\nv 1 1 0\nf 1 2 3 4\nf 5 2 7 6\nf 1 5 2\nf 2 3 7 4\n"
    )
    welded = welded_mesh(read_mesh(path))
    assert welded.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert (welded.corners.tolist(), welded.counts.tolist()) == ([0, 1, 2, 3, 1, 2, 3], [4, 3])


PLY = (
    b"ply\nformat %s 1.0\ncomment kept\nelement vertex 3\nproperty uchar red\nproperty double x\nproperty double y\n"
    b"property float z\nelement face 1\nproperty list uchar int vertex_indices\nelement extra 1\nproperty int n\n"
    b"end_header\n"
)


@pytest.mark.parametrize("kind", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_other_positions_in_a_ply_leave_the_rest_unchanged(tmp_path, kind):
    points = [(0.0, 0.0, 0.5), (1.0, 0.0, 0.5), (0.0, 1.0, 0.5)]
    if kind == "ascii":
        body = b"".join(b"7 %g %g %g\n" % p for p in points) + b"3 0 1 2\n42\n"
    else:
        order = "<" if "little" in kind else ">"
        body = b"".join(struct.pack(order + "Bddf", 7, *p) for p in points)
        body += struct.pack(order + "Biii", 3, 0, 1, 2) + struct.pack(order + "i", 42)
    source, target = tmp_path / "a.ply", tmp_path / "b.ply"
    source.write_bytes(PLY % kind.encode() + body)
    moved = np.array(points) + (0.1, -0.2, 0.25)
    write_repositioned(source, target, moved)
    assert np.array_equal(read_mesh(target).vertices, moved)
    write_repositioned(target, target.with_name("c.ply"), np.array(points))
    again = target.with_name("c.ply").read_bytes()
    if kind == "ascii":
        assert again.split()[: len(PLY.split())] == source.read_bytes().split()[: len(PLY.split())]
        assert again.endswith(b"3 0 1 2\n42\n")
    else:
        assert again == source.read_bytes()


def test_a_ply_with_integer_positions_is_refused(tmp_path):
    source = tmp_path / "a.ply"
    source.write_bytes((PLY % b"ascii").replace(b"float z", b"int z") + b"7 0 0 1\n7 1 0 1\n7 0 1 1\n3 0 1 2\n1\n")
    with pytest.raises(stiv.InputError, match='"z" is an integer'):
        write_repositioned(source, tmp_path / "b.ply", np.zeros((3, 3)))


def test_an_npz_keeps_its_other_arrays(tmp_path):
    source, target = tmp_path / "a.npz", tmp_path / "b.npz"
    np.savez(source, vertices=np.eye(3, dtype=np.float32), triangles=[[0, 1, 2]], colours=np.arange(5))
    write_repositioned(source, target, np.full((3, 3), 0.5))
    with np.load(target) as archive:
        assert archive["vertices"].dtype == np.float32 and (archive["vertices"] == 0.5).all()
        assert archive["colours"].tolist() == [0, 1, 2, 3, 4]
