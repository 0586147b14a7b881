# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixtures as plain data: objects, a view, and the steps of an edit script, in world units and radians."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .shape import Shape, rotation_matrix

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Placement:
    """An object's own transform, relative to its parent: location, XYZ Euler angles, scale along its axes."""

    location: Triple = (0.0, 0.0, 0.0)
    rotation: Triple = (0.0, 0.0, 0.0)
    scale: Triple = (1.0, 1.0, 1.0)

    def matrix(self) -> NDArray[np.float64]:
        """The 4x4 matrix location x rotation x scale."""
        matrix = np.eye(4)
        matrix[:3, :3] = rotation_matrix(self.rotation) * np.asarray(self.scale)
        matrix[:3, 3] = self.location
        return matrix


@dataclass(frozen=True)
class Material:
    """Base colour with opacity, linear RGBA, and roughness."""

    name: str
    color: tuple[float, float, float, float]
    roughness: float = 0.5


@dataclass(frozen=True)
class Subdivision:
    """A Subdivision Surface modifier. Creases are Blender's, in [0, 1]: by edge (ends in any order) and by vertex."""

    levels: int
    edge_creases: tuple[tuple[int, int, float], ...] = ()
    vertex_creases: tuple[tuple[int, float], ...] = ()
    limit_surface: bool = True
    keep_corners: bool = False


@dataclass(frozen=True)
class Modifier:
    """Any modifier: its type and name in Blender, and its settings."""

    kind: str
    name: str
    settings: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class VertexGroup:
    """A vertex group: vertices and their weights."""

    name: str
    weights: dict[int, float]


@dataclass(frozen=True)
class MeshObject:
    """A mesh with an optional Lattice modifier (`lattice` names the object) before its Subdivision Surface
        modifier, and others before both.

    An additional object, as the add-on creates it, shows `loop` levels of Loop subdivision; 0 for none.
    """

    name: str
    shape: Shape
    material: Material
    placement: Placement = Placement()
    parent: str | None = None
    lattice: str | None = None
    subdivision: Subdivision | None = None
    loop: int = 0
    smooth: bool = True
    groups: tuple[VertexGroup, ...] = ()
    modifiers: tuple[Modifier, ...] = ()


@dataclass(frozen=True)
class LatticeObject:
    """A centred lattice of (u, v, w) points, one local unit apart, as in Blender."""

    name: str
    resolution: tuple[int, int, int]
    placement: Placement
    interpolation: str = "KEY_BSPLINE"


@dataclass(frozen=True)
class EmptyObject:
    """An object without data, used as a parent."""

    name: str
    placement: Placement


@dataclass(frozen=True)
class View:
    """Position and target of the camera, its focal length in millimetres, and the size of the picture in pixels."""

    camera: Triple
    target: Triple = (0.0, 0.0, 0.0)
    lens: float = 50.0
    size: tuple[int, int] = (800, 600)


@dataclass(frozen=True)
class Fixture:
    """One scene, named after the feature it shows, and its edit script."""

    name: str
    summary: str
    meshes: tuple[MeshObject, ...]
    steps: tuple[dict[str, Any], ...]
    view: View
    lattices: tuple[LatticeObject, ...] = ()
    empties: tuple[EmptyObject, ...] = ()
    settings: dict[str, Any] = field(default_factory=dict)


def lattice_around(
    name: str, low: Triple, high: Triple, resolution: tuple[int, int, int], interpolation: str = "KEY_BSPLINE"
) -> LatticeObject:
    """An axis-aligned lattice whose outermost points span the box `low` .. `high`."""
    extent = np.subtract(high, low) / (np.array(resolution) - 1)
    centre = np.add(low, high) / 2
    placement = Placement(location=tuple(centre.tolist()), scale=tuple(extent.tolist()))
    return LatticeObject(name, resolution, placement, interpolation)
