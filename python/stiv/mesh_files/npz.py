# SPDX-License-Identifier: GPL-3.0-or-later
"""NumPy archives with `vertices` (N, 3), `triangles` (F, 3), and optionally `object_names` and `triangle_object`.

The reader compares the headers of arrays with the sizes in the archive before it allocates memory. It never loads
pickled objects.
"""

from __future__ import annotations

import lzma
import tokenize
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from stiv import InputError
from stiv.mesh_files.mesh import Mesh, checked_mesh

MAX_ARRAY_BYTES = 2 * 2**30
# Exceptions of zipfile for invalid, damaged or encrypted archives, and for names that are not text.
UNREADABLE = (
    zipfile.BadZipFile,
    EOFError,
    NotImplementedError,
    RuntimeError,
    UnicodeDecodeError,
    lzma.LZMAError,
    zlib.error,
)


def read_npz(path: Path) -> Mesh:
    """Reads an NPZ file."""
    try:
        with zipfile.ZipFile(path) as archive:
            vertices = _array(archive, "vertices", "fiu", 3)
            triangles = _array(archive, "triangles", "iu", 3)
            names = _optional(archive, "object_names", "U")
            owners = _optional(archive, "triangle_object", "iu")
    except UNREADABLE as error:
        raise InputError(f"not a readable NPZ archive: {error}") from error
    object_names = (path.stem,) if names is None else _texts(names, "object_names")
    owner = None if owners is None else owners.astype(np.int64)
    return checked_mesh(vertices.astype(float), triangles.astype(np.int64), object_names, owner)


def _texts(array: NDArray[np.str_], name: str) -> tuple[str, ...]:
    """Decodes texts, because NumPy does not check that four bytes are a character."""
    encoding = "utf-32-be" if array.dtype.str.startswith(">") else "utf-32-le"
    rows = array.view(np.uint8).reshape(len(array), array.dtype.itemsize)
    try:
        return tuple(row.tobytes().decode(encoding).rstrip("\0") for row in rows)
    except UnicodeDecodeError as error:
        raise InputError(f'array "{name}": not a text: {error.reason}') from error


def _optional(archive: zipfile.ZipFile, name: str, kinds: str) -> NDArray[Any] | None:
    return _array(archive, name, kinds, None) if f"{name}.npy" in archive.namelist() else None


def _array(archive: zipfile.ZipFile, name: str, kinds: str, columns: int | None) -> NDArray[Any]:
    """Reads an array of shape (N, columns), or (N,) for None, with a dtype of one of these kinds."""
    if f"{name}.npy" not in archive.namelist():
        raise InputError(f'the array "{name}" is missing')
    member = archive.getinfo(f"{name}.npy")
    with archive.open(member) as stream:
        shape, column_major, dtype = _header(stream, name)
        if dtype.hasobject or dtype.kind not in kinds or dtype.itemsize == 0:
            raise InputError(f'array "{name}": type {dtype} is not supported')
        if len(shape) != (1 if columns is None else 2) or (columns is not None and shape[1] != columns):
            raise InputError(
                f'array "{name}": shape {shape} where (N{"" if columns is None else f", {columns}"}) is needed'
            )
        size = dtype.itemsize * int(np.prod(shape, dtype=object))
        if size > min(MAX_ARRAY_BYTES, member.file_size):
            raise InputError(
                f'array "{name}": its header promises {size} bytes, more than it holds or than can be read'
            )
        data = stream.read(size)
    if len(data) != size:
        raise InputError(f'array "{name}": ends too early')
    flat = np.frombuffer(data, dtype)
    return flat.reshape(shape, order="F" if column_major else "C")


def _header(stream: Any, name: str) -> tuple[tuple[int, ...], bool, np.dtype[Any]]:
    try:
        version = npy.read_magic(stream)
        reader = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
        shape, column_major, dtype = reader(stream)
    except (ValueError, TypeError, SyntaxError, RecursionError, tokenize.TokenError) as error:
        raise InputError(f'array "{name}": not a NumPy array: {error}') from error
    if any(length < 0 for length in shape):
        raise InputError(f'array "{name}": negative length in its shape {shape}')
    return shape, column_major, dtype
