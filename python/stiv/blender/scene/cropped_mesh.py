# SPDX-License-Identifier: GPL-3.0-or-later
"""Some elements of a mesh."""

from dataclasses import dataclass

from stiv.blender.scene.arrays import Indices, Singles


@dataclass(frozen=True)
class CroppedMesh:
    """Some faces, loose edges and loose vertices of a mesh.

    Attributes:
        vertices: ascending vertex numbers, (n,).
        local: positions, (n, 3).
        triangles: Blender's triangulation, indices into `vertices`, (f, 3).
        faces: face of each triangle, (f,).
        loose_edges: indices into `vertices`, (l, 2).
        loose_numbers: edge number of each loose edge, (l,).
        size: number of vertices of the whole mesh.
    """

    vertices: Indices
    local: Singles
    triangles: Indices
    faces: Indices
    loose_edges: Indices
    loose_numbers: Indices
    size: int
