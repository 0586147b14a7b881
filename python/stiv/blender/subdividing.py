# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Subdivision Surface modifier as a deformation of the core."""

import bpy

import stiv
from stiv.blender.mesh_reading import read_creases, read_edges, read_faces
from stiv.blender.modifier_stack import Subdivision


def subdivide(mesh: bpy.types.Mesh, stage: Subdivision) -> stiv.Deformation:
    """From world positions of the cage's vertices to those of the subdivided mesh, in Blender's order."""
    corners, starts = read_faces(mesh)
    edge_crease, vertex_crease = read_creases(mesh) if stage.use_creases else (None, None)
    cage = stiv.Cage(len(mesh.vertices), corners, starts, read_edges(mesh), edge_crease, vertex_crease)
    deformation, _ = stiv.catmull_clark(
        cage,
        stage.levels,
        limit_surface=stage.limit_surface,
        quality=stage.quality,
        simple=stage.simple,
        boundary=stage.boundary,
    )
    return deformation
