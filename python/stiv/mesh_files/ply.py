# SPDX-License-Identifier: GPL-3.0-or-later
"""PLY, text and binary: x, y, z of vertices and the indices of faces. Ignores other properties."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stiv import InputError
from stiv.mesh_files.mesh import Mesh, polygon_mesh
from stiv.mesh_files.ply_header import Element, Header, Property, read_header

_INDEX_NAMES = ("vertex_indices", "vertex_index")
Columns = dict[str, NDArray[np.float64]]
Lists = tuple[NDArray[np.int64], NDArray[np.int64]]  # entries row by row; number in each row


def read_ply(path: Path) -> Mesh:
    """Reads a PLY file."""
    data = path.read_bytes()
    header = read_header(data)
    body = _AsciiBody(data, header) if header.byte_order is None else _BinaryBody(data, header)
    vertices: NDArray[np.float64] | None = None
    corners: Lists = (np.zeros(0, np.int64), np.zeros(0, np.int64))
    for element in header.elements:
        columns, lists = body.read(element)
        if element.name == "vertex":
            vertices = _coordinates(columns, element)
        elif element.name == "face":
            corners = _corners(lists, element)
    if vertices is None:
        raise InputError('the element "vertex" is missing')
    return polygon_mesh(vertices, *corners, (path.stem,))


def _coordinates(columns: Columns, element: Element) -> NDArray[np.float64]:
    missing = [axis for axis in "xyz" if axis not in columns]
    if missing:
        raise InputError(f'element "vertex": the property "{missing[0]}" is missing')
    return np.stack([columns[axis] for axis in "xyz"], axis=1).reshape(element.count, 3)


def _corners(lists: dict[str, Lists], element: Element) -> Lists:
    for name in _INDEX_NAMES:
        if name in lists:
            return lists[name]
    raise InputError(f'element "{element.name}": the list property "vertex_indices" is missing')


class _AsciiBody:
    """Elements as lines of words."""

    def __init__(self, data: bytes, header: Header) -> None:
        self._lines = data[header.size :].decode("ascii", errors="replace").splitlines()
        self._next = 0

    def read(self, element: Element) -> tuple[Columns, dict[str, Lists]]:
        lines = self._lines[self._next : self._next + element.count]
        if len(lines) < element.count:
            raise InputError(
                f'element "{element.name}": the header announces {element.count} rows, the file ends after {len(lines)}'
            )
        self._next += element.count
        values: dict[str, list[float]] = {p.name: [] for p in element.properties}
        counts: dict[str, list[int]] = {p.name: [] for p in element.properties if p.count_type}
        for number, line in enumerate(lines):
            try:
                self._read_row(line.split(), element, values, counts)
            except (ValueError, IndexError, OverflowError) as error:
                raise InputError(f'element "{element.name}" {number}: {error}') from error
        columns = {p.name: np.array(values[p.name], float) for p in element.properties if not p.count_type}
        lists = {
            name: (_whole(np.array(values[name], float), element), np.array(counts[name], np.int64)) for name in counts
        }
        return columns, lists

    @staticmethod
    def _read_row(
        words: list[str], element: Element, values: dict[str, list[float]], counts: dict[str, list[int]]
    ) -> None:
        at = 0
        for prop in element.properties:
            length = 1
            if prop.count_type:
                length = int(words[at])
                counts[prop.name].append(length)
                at += 1
            if length < 0 or at + length > len(words):
                raise InputError("too few numbers on its line")
            values[prop.name] += map(float, words[at : at + length])
            at += length


def _whole(numbers: NDArray[np.float64], element: Element) -> NDArray[np.int64]:
    if not (np.abs(numbers) < 2**53).all() or (numbers != np.floor(numbers)).any():
        raise InputError(f'element "{element.name}": an index is not an integer')
    return numbers.astype(np.int64)


class _BinaryBody:
    """Elements as binary numbers. Sizes are compared with the file before anything is allocated."""

    def __init__(self, data: bytes, header: Header) -> None:
        self._data, self._order, self._at = data, header.byte_order or "<", header.size

    def read(self, element: Element) -> tuple[Columns, dict[str, Lists]]:
        least = sum(np.dtype(prop.count_type or prop.value_type).itemsize for prop in element.properties)
        if element.count * least > len(self._data) - self._at:
            raise InputError(
                f'element "{element.name}": the header announces {element.count} rows, more than the file contains'
            )
        if not any(prop.count_type for prop in element.properties):
            return self._table(element, least), {}
        return self._rows(element)

    def _table(self, element: Element, row_size: int) -> Columns:
        row = np.dtype([(prop.name, self._order + prop.value_type) for prop in element.properties])
        table = np.frombuffer(self._data, row, element.count, self._at)
        self._at += element.count * row_size
        return {prop.name: table[prop.name].astype(float) for prop in element.properties}

    def _rows(self, element: Element) -> tuple[Columns, dict[str, Lists]]:
        """Rows with lists: one table if all lists are as long as those of the first row, otherwise row by row."""
        start = self._at
        lengths = [len(values) for values in self._row(element, 0).values()] if element.count else []
        row = np.dtype(
            [field for p, n in zip(element.properties, lengths, strict=False) for field in self._fields(p, n)]
        )
        self._at = start
        if element.count and element.count * row.itemsize <= len(self._data) - start:
            table = np.frombuffer(self._data, row, element.count, start)
            lists = {p.name: n for p, n in zip(element.properties, lengths, strict=True) if p.count_type}
            if all((table["count of " + name] == length).all() for name, length in lists.items()):
                self._at += table.nbytes
                return self._split({name: list(table[name]) for name in (p.name for p in element.properties)}, element)
        rows = [self._row(element, number) for number in range(element.count)]
        return self._split({p.name: [row[p.name] for row in rows] for p in element.properties}, element)

    def _fields(self, prop: Property, length: int) -> list[tuple[str, str, tuple[int, ...]]]:
        values = (prop.name, self._order + prop.value_type, (length,))
        return [("count of " + prop.name, self._order + prop.count_type, ()), values] if prop.count_type else [values]

    def _row(self, element: Element, number: int) -> dict[str, NDArray[np.float64]]:
        row = {}
        for prop in element.properties:
            where = f'element "{element.name}" {number}'
            length = int(self._take(prop.count_type, 1, where)[0]) if prop.count_type else 1
            row[prop.name] = self._take(prop.value_type, length, where)
        return row

    @staticmethod
    def _split(rows: dict[str, list[NDArray[np.float64]]], element: Element) -> tuple[Columns, dict[str, Lists]]:
        flat = {name: np.concatenate([*values, np.zeros(0)]) for name, values in rows.items()}
        columns = {p.name: flat[p.name] for p in element.properties if not p.count_type}
        lists = {
            p.name: (_whole(flat[p.name], element), np.array([len(row) for row in rows[p.name]], np.int64))
            for p in element.properties
            if p.count_type
        }
        return columns, lists

    def _take(self, kind: str, count: int, where: str) -> NDArray[np.float64]:
        dtype = np.dtype(self._order + kind)
        if count < 0 or count * dtype.itemsize > len(self._data) - self._at:
            raise InputError(f"{where}: the file ends within it")
        values = np.frombuffer(self._data, dtype, count, self._at).astype(float)
        self._at += count * dtype.itemsize
        return values
