# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading of mesh files: OBJ, PLY (ascii and binary) and NPZ, safe against files made to harm."""

from stiv.mesh_files.mesh import Mesh
from stiv.mesh_files.reading import SUFFIXES, read_mesh

__all__ = ["SUFFIXES", "Mesh", "read_mesh"]
