# SPDX-License-Identifier: GPL-3.0-or-later
"""Wavefront OBJ: vertices, polygons and object names. Ignores everything else."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from stiv import InputError
from stiv.mesh_files.mesh import Mesh, polygon_mesh


@dataclass
class _Contents:
    """State of the reader."""

    vertices: list[tuple[float, float, float]] = field(default_factory=list)
    corners: list[int] = field(default_factory=list)
    counts: list[int] = field(default_factory=list)
    owners: list[int] = field(default_factory=list)
    names: list[str] = field(default_factory=list)


def read_obj(path: Path) -> Mesh:
    """Reads an OBJ file. Negative indices count back from the last vertex."""
    contents = _Contents()
    with path.open(encoding="utf-8", errors="replace") as lines:
        for number, line in enumerate(lines, 1):
            try:
                _read_line(line.split(), contents, path.stem)
            except (ValueError, IndexError, OverflowError) as error:
                raise InputError(f"line {number}: {error}") from error
    corners, counts = np.array(contents.corners, np.int64), np.array(contents.counts, np.int64)
    vertices = np.array(contents.vertices, float).reshape(-1, 3)
    names = tuple(contents.names) or (path.stem,)
    return polygon_mesh(vertices, corners, counts, names, np.array(contents.owners, np.int64))


def _read_line(words: list[str], contents: _Contents, default_name: str) -> None:
    if not words:
        return
    if words[0] == "v":
        if len(words) < 4:
            raise InputError("a vertex needs three coordinates")
        contents.vertices.append((float(words[1]), float(words[2]), float(words[3])))
    elif words[0] == "o":
        contents.names.append(" ".join(words[1:]) or default_name)
    elif words[0] == "f":
        if len(words) < 4:
            raise InputError("a face needs three corners")
        if not contents.names:
            contents.names.append(default_name)
        contents.corners += [_index(word, len(contents.vertices)) for word in words[1:]]
        contents.counts.append(len(words) - 1)
        contents.owners.append(len(contents.names) - 1)


def _index(word: str, count: int) -> int:
    """Zero-based index of a corner such as `7`, `7/1/3` or `-1`."""
    value = int(word.split("/", 1)[0])
    index = value - 1 if value > 0 else count + value
    if value == 0 or not 0 <= index < 2**31:
        raise InputError(f"vertex index {value} is out of range; {count} vertices so far")
    return index
