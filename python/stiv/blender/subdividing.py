# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Subdivision Surface modifier as a deformation of the core."""

from typing import Any

import bpy

import stiv
from stiv.blender.arrays import Indices, Singles
from stiv.blender.mesh_reading import read_creases, read_edges, read_faces
from stiv.blender.modifier_stack import Subdivision
from stiv.blender.remembering import remembered


def subdivide(mesh: bpy.types.Mesh, stage: Subdivision) -> stiv.Deformation:
    """From world positions of the cage's vertices to those of the subdivided mesh, in Blender's order."""
    corners, starts = read_faces(mesh)
    edge_crease, vertex_crease = read_creases(mesh) if stage.use_creases else (None, None)
    cage = (len(mesh.vertices), corners, starts, read_edges(mesh), edge_crease, vertex_crease)
    return remembered(_smooth, *cage, stage.levels, stage.limit_surface, stage.quality, stage.simple, stage.boundary)


def _smooth(
    count: int,
    corners: Indices,
    starts: Indices,
    edges: Indices,
    edge_crease: Singles | None,
    vertex_crease: Singles | None,
    levels: int,
    limit_surface: bool,
    quality: int,
    simple: bool,
    boundary: Any,
) -> stiv.Deformation:
    cage = stiv.Cage(count, corners, starts, edges, edge_crease, vertex_crease)
    deformation, _ = stiv.catmull_clark(
        cage, levels, limit_surface=limit_surface, quality=quality, simple=simple, boundary=boundary
    )
    return deformation
