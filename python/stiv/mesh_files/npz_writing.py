# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing of NPZ files: what `read_npz` reads, the same bytes for the same mesh."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from stiv.mesh_files.mesh import Mesh


def write_npz(path: Path, mesh: Mesh) -> None:
    """Writes the mesh with its objects to a NumPy archive. Raises OSError."""
    np.savez(
        path,
        vertices=mesh.vertices,
        triangles=mesh.triangles,
        object_names=np.array(mesh.object_names, dtype=str),
        triangle_object=mesh.triangle_object,
    )
