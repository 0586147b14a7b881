# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies mesh files with other positions of vertices. Faces, textures and names stay the same."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stiv import InputError
from stiv.mesh_files.ply_header import Element, read_header

Floats = NDArray[np.float64]


def write_repositioned(source: Path, target: Path, vertices: Floats) -> None:
    """Copy an OBJ, PLY or NPZ file, which was read before, with other positions, (N, 3), in the same format.

    Raises InputError if the format of the file cannot store them, OSError.
    """
    suffix = source.suffix.lower()
    {".obj": _obj, ".ply": _ply, ".npz": _npz}[suffix](source, target, vertices)


def _obj(source: Path, target: Path, vertices: Floats) -> None:
    """Replaces the coordinates in `v` lines. Other numbers in them (weights, colors) stay."""
    rows = iter(vertices.tolist())
    with source.open("rb") as lines, target.open("wb") as out:
        for line in lines:
            words = line.split()
            if words[:1] != [b"v"]:
                out.write(line)
                continue
            ending = line[len(line.rstrip()) :]
            numbers = [repr(value).encode() for value in next(rows)]
            out.write(b" ".join([b"v", *numbers, *words[4:]]) + ending)


def _npz(source: Path, target: Path, vertices: Floats) -> None:
    with np.load(source, allow_pickle=False) as archive:
        arrays = {name: archive[name] for name in archive.files}
    kind = arrays["vertices"].dtype
    arrays["vertices"] = vertices.astype(kind if kind.kind == "f" else np.float64)
    with target.open("wb") as out:
        np.savez(out, **arrays)


def _ply(source: Path, target: Path, vertices: Floats) -> None:
    data = source.read_bytes()
    header = read_header(data)
    if any(element.name == "vertex" for element in header.elements[1:]):
        raise InputError("vertices are not the first element; choose another output format, such as .obj")
    element = header.elements[0]
    _check_room(element)
    write = _ply_text if header.byte_order is None else _ply_table
    target.write_bytes(write(data, header.size, header.byte_order or "", element, vertices))


def _check_room(element: Element) -> None:
    for prop in element.properties:
        if prop.count_type:
            raise InputError(f'element "vertex": has a list, "{prop.name}"; choose another output format')
        if prop.name in "xyz" and not prop.value_type.startswith("f"):
            raise InputError(f'element "vertex": "{prop.name}" is an integer; choose another output format')


def _ply_text(data: bytes, size: int, order: str, element: Element, vertices: Floats) -> bytes:
    columns = [[prop.name for prop in element.properties].index(axis) for axis in "xyz"]
    lines = data[size:].splitlines(keepends=True)
    for number, row in enumerate(vertices.tolist()):
        words = lines[number].split()
        for column, value in zip(columns, row, strict=True):
            words[column] = repr(value).encode()
        lines[number] = b" ".join(words) + b"\n"
    return data[:size] + b"".join(lines)


def _ply_table(data: bytes, size: int, order: str, element: Element, vertices: Floats) -> bytes:
    table = np.frombuffer(
        data, np.dtype([(prop.name, order + prop.value_type) for prop in element.properties]), element.count, size
    ).copy()
    for axis, name in enumerate("xyz"):
        table[name] = vertices[:, axis]
    return data[:size] + table.tobytes() + data[size + table.nbytes :]
