# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes mesh files, by suffix: OBJ and PLY with polygons, NPZ with triangles."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from stiv import InputError
from stiv.mesh_files.mesh import Mesh


def write_mesh(path: Path, mesh: Mesh) -> None:
    """Write a mesh to an OBJ, PLY or NPZ file. Raises InputError for another suffix, OSError."""
    require_writer(path)
    _WRITERS[path.suffix.lower()](path, mesh)


def require_writer(path: Path) -> None:
    """Raises InputError if files of this suffix cannot be written."""
    if path.suffix.lower() not in _WRITERS:
        raise InputError(f"{path}: cannot write this format; supported are {', '.join(_WRITERS)}")


def _write_obj(path: Path, mesh: Mesh) -> None:
    """Coordinates have enough digits to be read back exactly."""
    with path.open("w", encoding="utf-8", newline="\n") as out:
        out.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in mesh.vertices.tolist())
        last = -1
        for polygon, owner in _polygons(mesh):
            if owner != last:
                out.write(f"o {mesh.object_names[owner]}\n")
                last = owner
            out.write("f " + " ".join(str(index + 1) for index in polygon) + "\n")


def _write_ply(path: Path, mesh: Mesh) -> None:
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(mesh.vertices)}\nproperty double x\n"
        f"property double y\nproperty double z\nelement face {len(mesh.counts)}\n"
        "property list int int vertex_indices\nend_header\n"
    )
    with path.open("wb") as out:
        out.write(header.encode("ascii"))
        out.write(mesh.vertices.astype("<f8").tobytes())
        for polygon, _ in _polygons(mesh):
            out.write(np.array([len(polygon), *polygon], "<i4").tobytes())


def _write_npz(path: Path, mesh: Mesh) -> None:
    with path.open("wb") as out:
        np.savez(
            out,
            vertices=mesh.vertices,
            triangles=mesh.triangles,
            object_names=np.array(mesh.object_names),
            triangle_object=mesh.triangle_object,
        )


def _polygons(mesh: Mesh) -> Iterator[tuple[list[int], int]]:
    ends = np.cumsum(mesh.counts).tolist()
    for end, count, owner in zip(ends, mesh.counts.tolist(), mesh.polygon_object.tolist(), strict=True):
        yield mesh.corners[end - count : end].tolist(), owner


_WRITERS: dict[str, Callable[[Path, Mesh], None]] = {".obj": _write_obj, ".ply": _write_ply, ".npz": _write_npz}
