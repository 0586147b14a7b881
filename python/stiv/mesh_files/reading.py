# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads mesh files, by suffix."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from stiv import InputError
from stiv.mesh_files.mesh import Mesh
from stiv.mesh_files.npz import read_npz
from stiv.mesh_files.obj import read_obj
from stiv.mesh_files.ply import read_ply

_READERS: dict[str, Callable[[Path], Mesh]] = {".obj": read_obj, ".ply": read_ply, ".npz": read_npz}
SUFFIXES = tuple(_READERS)


def read_mesh(path: Path | str) -> Mesh:
    """Reads an OBJ, PLY or NPZ file; polygons become fans of triangles. Raises InputError naming file and element."""
    path = Path(path)
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise InputError(f"{path}: unknown format; supported are {', '.join(SUFFIXES)} and .blend")
    try:
        return reader(path)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error
    except MemoryError as error:
        raise InputError(f"{path}: too large for the memory of this computer") from error
