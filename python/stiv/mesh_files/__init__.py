# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh files: OBJ, PLY (text and binary) and NPZ. The readers are safe for untrusted files."""

from stiv.mesh_files.mesh import Mesh
from stiv.mesh_files.reading import SUFFIXES, read_mesh
from stiv.mesh_files.repositioning import write_repositioned
from stiv.mesh_files.welded import welded_mesh
from stiv.mesh_files.writing import require_writer, write_mesh

__all__ = ["SUFFIXES", "Mesh", "read_mesh", "require_writer", "welded_mesh", "write_mesh", "write_repositioned"]
