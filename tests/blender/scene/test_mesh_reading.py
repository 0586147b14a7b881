# SPDX-License-Identifier: GPL-3.0-or-later
"""The triangulation of meshes, compared with the one that Blender computes."""

from typing import Any

import bpy
import numpy as np
import pytest
from building import add, edit_mode, mesh

from stiv.blender.scene.mesh_reading import read_triangles

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0.5, 1), (-1, 0.5, 1), (0.5, 2, 0.5)]
FACES = {
    "triangles": [(2, 0, 1), (0, 2, 3), (4, 2, 1), (3, 5, 0)],
    "a triangle and a quad": [(2, 0, 1), (0, 2, 3, 5)],
    "a triangle and a pentagon": [(0, 1, 2), (2, 6, 3, 0, 4)],
    "no faces": [],
}


def triangles_of(data: Any) -> tuple[list[list[int]], list[int]]:
    data.calc_loop_triangles()
    return [list(each.vertices) for each in data.loop_triangles], [each.polygon_index for each in data.loop_triangles]


@pytest.mark.parametrize("kind", FACES)
@pytest.mark.parametrize("edited", [False, True])
def test_triangles_and_faces_are_those_of_blender(kind: str, edited: bool) -> None:
    ob = add("Mesh", mesh("Mesh", CORNERS, FACES[kind]))
    expected = triangles_of(ob.data)
    if edited:
        edit_mode(ob)
    evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    copy = evaluated.to_mesh()
    for data in (ob.data, copy):
        triangles, faces = read_triangles(data)
        assert triangles.dtype == faces.dtype == np.int32 and triangles.shape == (len(faces), 3)
        assert (triangles.tolist(), faces.tolist()) == expected
    evaluated.to_mesh_clear()
