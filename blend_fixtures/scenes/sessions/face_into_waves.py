# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 7: a subdivision face pressed into a wavy surface, in one edit."""

from __future__ import annotations

import numpy as np

from ..colors import FUR, STILL
from ..fixture import Fixture, MeshObject, View
from ..motion import move, on_points
from ..primitives import grid, triangulated
from ..shape import Shape
from ..walls import wavy_wall
from .session import Session, Stage, moved, single
from .subdivision_parts import Parts, part

DEPTH = 0.55


def face(cells: int = 14) -> Shape:
    """The cage of a face that looks down, -z: an oval with brow, eye hollows, nose, lips and chin."""
    flat = triangulated(grid(cells, cells, 2.0, 2.0))
    u, v = flat.vertices[:, 0], flat.vertices[:, 1]
    # the points of the square mapped to a disc, then to an oval
    reach = np.maximum(np.abs(u), np.abs(v)) / np.maximum(np.hypot(u, v), 1e-12)
    x, y = 0.8 * u * reach, 1.05 * v * reach

    def bump(at_x: float, at_y: float, wide: float, high: float, size: float) -> np.ndarray:
        return size * np.exp(-(((x - at_x) / wide) ** 2) - ((y - at_y) / high) ** 2)

    depth = 0.5 * np.sqrt(np.maximum(0.0, 1.05 - (x / 0.82) ** 2 - (y / 1.08) ** 2))
    depth += bump(0, -0.02, 0.11, 0.25, 0.22) + bump(0, -0.14, 0.16, 0.09, 0.1)  # nose
    depth -= bump(0.3, 0.18, 0.17, 0.1, 0.12) + bump(-0.3, 0.18, 0.17, 0.1, 0.12)  # eyes
    depth += bump(0, 0.36, 0.5, 0.1, 0.05) + bump(0, -0.42, 0.22, 0.06, 0.07) + bump(0, -0.75, 0.2, 0.14, 0.09)
    return Shape(np.column_stack([x, -y, -depth]), flat.faces)


def cages() -> tuple[Shape, Shape]:
    """The face above the waves."""
    cage = face()
    return cage.moved((0.05, 0.0, 0.2 - cage.vertices[:, 2].min())), triangulated(wavy_wall(56, 3.4, 0.12))


def parts() -> Parts:
    """The face subdivided."""
    above, waves = cages()
    return Parts({"Face": part(above, 2), "Waves": part(waves, 0)})


def stage() -> Stage:
    """The face pressed down; its cage yields."""
    return parts().by_cages("pressed", ("Face",), (moved((0, 0, -DEPTH)),))


def session() -> Session:
    """The session: one edit."""
    return Session("face", 7, "A subdivision face pressed into waves", single(stage))


def face_into_waves() -> Fixture:
    """The same session in Blender."""
    above, waves = cages()
    return Fixture(
        name="face_into_waves",
        summary="A subdivision face pressed into waves, in one edit",
        meshes=(MeshObject("Face", above, FUR, loop=2), MeshObject("Waves", waves, STILL)),
        steps=(move(on_points("Face"), (0.0, 0.0, -DEPTH)),),
        view=View((2.2, -2.6, 2.7), (0.0, 0.0, 0.1), 50.0),
    )
