# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's Subdivision Surface modifier as a deformation."""

from collections.abc import Sequence
from typing import Any

import bpy
import numpy as np

import stiv
from stiv.blender.controls.deformation_cache import cached_deformation
from stiv.blender.scene.arrays import Indices, Singles
from stiv.blender.scene.mesh_reading import read_creases, read_edges, read_faces
from stiv.blender.scene.modifier_stack import SubdivisionStage


def subdivide(mesh: bpy.types.Mesh, stage: SubdivisionStage) -> stiv.Deformation:
    """Deformation from the cage to the subdivided mesh in world space, in Blender's order of vertices."""
    corners, starts = read_faces(mesh)
    edge_crease, vertex_crease = read_creases(mesh) if stage.use_creases else (None, None)
    cage = (len(mesh.vertices), corners, starts, read_edges(mesh), edge_crease, vertex_crease)
    return cached_deformation(
        _catmull_clark, *cage, stage.levels, limit_surface=stage.limit_surface, quality=stage.quality,
        simple=stage.simple, boundary=stage.boundary,
    )  # fmt: skip


def identity_deformation(count: int) -> stiv.Deformation:
    """The identity as a linear deformation, for stacking."""
    return stiv.linear(identity_weights(count))


def identity_weights(count: int) -> stiv.Weights:
    """Weights of the identity."""
    rows = np.arange(count + 1, dtype=np.int32)
    return stiv.Weights(rows, rows[:-1], np.ones(count), (count, count))


def moved_columns(weights: stiv.Weights, first: int, count: int) -> stiv.Weights:
    """The weights of controls that are some of `count` controls, from the one with number `first`."""
    shape = (weights.shape[0], count)
    return stiv.Weights(weights.indptr, weights.indices + np.int32(first), weights.data, shape)


def is_linear(deformation: stiv.Deformation) -> bool:
    """Does the deformation have weights, so that a deformation by handles can precede it?"""
    try:
        stiv.linear_weights(deformation)
    except stiv.InputError:
        return False
    return True


def stack_deformations(deformations: Sequence[stiv.Deformation]) -> stiv.Deformation:
    """Stack linear deformations of the same controls."""
    if len(deformations) == 1:
        return deformations[0]
    parts = [stiv.linear_weights(deformation) for deformation in deformations]
    offsets = [np.zeros((each.shape[0], 3)) if offset is None else offset for each, offset in parts]
    return stiv.linear(stack_weights([each for each, _ in parts]), np.concatenate(offsets))


def stack_weights(weights: Sequence[stiv.Weights]) -> stiv.Weights:
    """Stack the weights of the same controls."""
    ends = np.cumsum([0, *(len(each.data) for each in weights)])
    starts = [np.asarray(each.indptr[:-1]) + end for each, end in zip(weights, ends, strict=False)]
    return stiv.Weights(
        np.append(np.concatenate(starts), ends[-1]),
        np.concatenate([each.indices for each in weights]),
        np.concatenate([each.data for each in weights]),
        (sum(each.shape[0] for each in weights), weights[0].shape[1]),
    )


def _catmull_clark(
    count: int, corners: Indices, starts: Indices, edges: Indices, edge_crease: Singles | None,
    vertex_crease: Singles | None, levels: int, **options: Any,
) -> stiv.Deformation:  # fmt: skip
    cage = stiv.Cage(count, corners, starts, edges, edge_crease, vertex_crease)
    return stiv.catmull_clark(cage, levels, **options)[0]
