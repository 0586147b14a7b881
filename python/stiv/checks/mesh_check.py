# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact test of a mesh file, without Blender."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

import stiv
from stiv import InputError
from stiv.arrays import Indices
from stiv.checks.findings import Element, Finding, Look, SeamPairs, Shapes
from stiv.edge_contacts import edge_contacts
from stiv.mesh_files import Mesh
from stiv.mesh_files.mesh import checked_mesh
from stiv.seams import Seams, object_seams, seam_pairs


def check_mesh(mesh: Mesh, objects: Collection[str] = ()) -> Look:
    """Tests all objects, or those named. Raises InputError for unknown names."""
    shapes = shapes_of(_limited(mesh, objects))

    def element(triangle: int) -> Element:
        return Element(shapes.names[shapes.owner[triangle]], "triangle", int(shapes.number[triangle]))

    seams = object_seams(shapes.positions, shapes.triangles, shapes.owner)
    pairs = _pairs(shapes, seams)
    touching = np.asarray(shapes.owner[pairs[:, 0]] == shapes.owner[pairs[:, 1]])
    touching[touching] = edge_contacts(shapes.positions, shapes.triangles, pairs[touching])
    findings = tuple(Finding(element(a), element(b)) for a, b in pairs[~touching].tolist())
    return Look(shapes, findings=findings, seams=_seam_pairs(shapes, seams, pairs[~touching], pairs[touching]))


def _seam_pairs(shapes: Shapes, seams: Seams | None, intersecting: Indices, touching: Indices) -> tuple[SeamPairs, ...]:
    """Pairs of triangles of each object on seams or touching only along edges, without those that intersect."""
    pairs = seam_pairs(seams, shapes.triangles, np.arange(len(shapes.triangles), dtype=np.int32))
    if len(touching):
        pairs = np.unique(np.concatenate([pairs, touching]), axis=0)
    meeting = set(map(tuple, intersecting.tolist()))
    if meeting:
        pairs = pairs[np.array([(a, b) not in meeting for a, b in pairs.tolist()], bool)]
    owner = shapes.owner[pairs[:, 0]]
    return tuple(
        SeamPairs(shapes.names[of], "triangle", shapes.number[pairs[owner == of]]) for of in np.unique(owner).tolist()
    )


def _pairs(shapes: Shapes, seams: Seams | None) -> Indices:
    if seams is None:
        return stiv.find_intersections(shapes.positions, shapes.triangles)
    return stiv.find_intersections(shapes.positions[seams.first], seams.index[shapes.triangles])


def shapes_of(mesh: Mesh) -> Shapes:
    """The triangles of a mesh, with their indices within objects."""
    owner = mesh.triangle_object
    order = np.argsort(owner, kind="stable")
    first = np.searchsorted(owner[order], np.arange(len(mesh.object_names)))
    number = np.empty(len(owner), np.int32)
    number[order] = np.arange(len(owner)) - first[owner[order]]
    return Shapes(mesh.vertices, mesh.triangles, mesh.object_names, owner, number)


def _limited(mesh: Mesh, objects: Collection[str]) -> Mesh:
    unknown = sorted(set(objects) - set(mesh.object_names))
    if unknown:
        raise InputError(f'there is no object "{unknown[0]}" in it; there are {", ".join(mesh.object_names)}')
    if not objects:
        return mesh
    kept = np.isin(mesh.triangle_object, [mesh.object_names.index(name) for name in objects])
    triangles, owners = mesh.triangles[kept].astype(np.int64), mesh.triangle_object[kept].astype(np.int64)
    return checked_mesh(mesh.vertices, triangles, mesh.object_names, owners)
