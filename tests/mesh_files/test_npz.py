# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading NPZ files, valid and hostile."""

import io
import pickle
import zipfile

import numpy as np
import pytest

import stiv
from stiv.mesh_files import read_mesh

VERTICES = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
TRIANGLES = np.array([[0, 1, 2], [0, 1, 3]])


def with_member(path, name, data):
    """An archive with valid vertices and triangles, except that these bytes replace `name`."""
    with zipfile.ZipFile(path, "w") as archive:
        for key, value in {"vertices": VERTICES, "triangles": TRIANGLES}.items():
            stream = io.BytesIO()
            np.save(stream, value)
            archive.writestr(f"{key}.npy", data if key == name else stream.getvalue())


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_arrays_are_read(tmp_path, save):
    path = tmp_path / "zwei Dreiecke ä.npz"
    owners = {"object_names": np.array(["a", "b ü"]), "triangle_object": np.array([0, 1])}
    save(path, vertices=np.asfortranarray(VERTICES), triangles=TRIANGLES.astype(np.uint16), **owners)
    mesh = read_mesh(path)
    assert np.array_equal(mesh.vertices, VERTICES) and np.array_equal(mesh.triangles, TRIANGLES)
    assert mesh.object_names == ("a", "b ü") and mesh.triangle_object.tolist() == [0, 1]


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"vertices": VERTICES}, 'the array "triangles" is missing'),
        ({"vertices": VERTICES[:, :2], "triangles": TRIANGLES}, 'array "vertices": shape'),
        ({"vertices": VERTICES, "triangles": TRIANGLES.astype(float)}, "type float64 is not supported"),
        ({"vertices": VERTICES, "triangles": TRIANGLES - 1}, "triangle 0: index out of range"),
        ({"vertices": VERTICES + np.float32(np.inf), "triangles": TRIANGLES}, "vertex 0: coordinate is not finite"),
        ({"vertices": VERTICES, "triangles": TRIANGLES, "triangle_object": np.array([0, 4])}, "do not match"),
    ],
)
def test_mismatched_arrays_are_named(tmp_path, arrays, message):
    path = tmp_path / "bad.npz"
    np.savez(path, **arrays)
    with pytest.raises(stiv.InputError, match=message):
        read_mesh(path)


class Trap:
    """Raises when unpickled."""

    def __reduce__(self):
        return (exec, ("raise SystemError('the trap went off')",))


def test_pickles_are_never_loaded(tmp_path):
    path = tmp_path / "trap.npz"
    np.savez(path, vertices=np.array([[Trap()] * 3], object), triangles=TRIANGLES)
    with pytest.raises(stiv.InputError, match="type object is not supported"):
        read_mesh(path)
    with_member(path, "vertices", pickle.dumps(Trap()))
    with pytest.raises(stiv.InputError, match="not a NumPy array"):
        read_mesh(path)


@pytest.mark.parametrize("shape", ["(1000000000000, 3)", "(10, 3)", "(-4, 3)"])
def test_a_header_with_too_large_a_shape_is_refused(tmp_path, shape):
    path = tmp_path / "bomb.npz"
    text = f"{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    with_member(path, "vertices", b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode() + bytes(96))
    with pytest.raises(stiv.InputError, match=r'array "vertices": (its header promises|negative length)'):
        read_mesh(path)


def archive_member(dtype, shape, data):
    text = f"{{'descr': {dtype!r}, 'fortran_order': False, 'shape': {shape}, }}".ljust(117) + "\n"
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode() + data


@pytest.mark.parametrize("code", [0x110000, 0xFFFFFFFF, 0xD800])
@pytest.mark.parametrize("order", ["little", "big"])
def test_names_with_invalid_characters_are_refused(tmp_path, code, order):
    path = tmp_path / "names.npz"
    np.savez(path, vertices=VERTICES, triangles=TRIANGLES)
    with zipfile.ZipFile(path, "a") as archive:
        dtype = "<U2" if order == "little" else ">U2"
        archive.writestr("object_names.npy", archive_member(dtype, "(1,)", code.to_bytes(4, order) + bytes(4)))
    with pytest.raises(stiv.InputError, match=r'names\.npz: array "object_names": not a text'):
        read_mesh(path)


def test_names_of_length_zero_are_refused(tmp_path):
    path = tmp_path / "names.npz"
    np.savez(path, vertices=VERTICES, triangles=TRIANGLES)
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("object_names.npy", archive_member("<U0", "(1000000,)", b""))
    with pytest.raises(stiv.InputError, match='array "object_names": type'):
        read_mesh(path)


def test_a_header_that_ends_within_brackets_is_refused(tmp_path):
    path = tmp_path / "open.npz"
    with_member(path, "vertices", archive_member("<f8", "(4, 3", bytes(96)))
    with pytest.raises(stiv.InputError, match='array "vertices": not a NumPy array'):
        read_mesh(path)


def test_noise_is_refused(tmp_path):
    path = tmp_path / "noise.npz"
    path.write_bytes(np.random.default_rng(1).bytes(3000))
    with pytest.raises(stiv.InputError, match="not a readable NPZ archive"):
        read_mesh(path)


def test_members_with_undecodable_names_are_refused(tmp_path):
    path = tmp_path / "names.npz"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("vertices ä.npy", b"")
    path.write_bytes(path.read_bytes().replace("ä".encode(), b"\xff\xff"))
    with pytest.raises(stiv.InputError, match=r"names\.npz: not a readable NPZ archive"):
        read_mesh(path)


@pytest.mark.parametrize("compression", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_a_damaged_stream_is_refused(tmp_path, compression):
    path = tmp_path / "damaged.npz"
    with zipfile.ZipFile(path, "w", compression) as archive:
        archive.writestr("vertices.npy", archive_member("<f8", "(4, 3)", bytes(96)))
        archive.writestr("triangles.npy", archive_member("<i8", "(1, 3)", bytes(24)))
        begin = archive.getinfo("vertices.npy").header_offset + 30 + len("vertices.npy")
    data = bytearray(path.read_bytes())
    data[begin + 9 : begin + 40] = bytes([0xFF] * 31)
    path.write_bytes(data)
    with pytest.raises(stiv.InputError, match=r"damaged\.npz"):
        read_mesh(path)


def test_a_flipped_byte_is_an_error_or_harmless(tmp_path):
    good = tmp_path / "good.npz"
    np.savez_compressed(good, vertices=VERTICES, triangles=TRIANGLES)
    data, path = good.read_bytes(), tmp_path / "flipped.npz"
    for position in range(0, len(data), 7):
        path.write_bytes(data[:position] + bytes([data[position] ^ 0xFF]) + data[position + 1 :])
        try:
            read_mesh(path)
        except stiv.InputError as error:
            assert "flipped.npz" in str(error)
