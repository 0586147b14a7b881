# SPDX-License-Identifier: GPL-3.0-or-later
"""Data for the overlay as arrays of world positions: contacts of an edit, and intersecting faces."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from numpy.typing import NDArray

import stiv
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.edit.culled_edit import CulledEdit
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.elements import FacePair
from stiv.blender.scene.evaluated_scene import read_scene
from stiv.blender.scene.evaluations import SHOWN

MAX_CONTACTS = 2000  # an even selection is drawn if there are more


@dataclass(frozen=True)
class Contacts:
    """Contacts of an edit.

    Attributes:
        points: (k, 3) midpoints between the contact points of both sides.
        blocked: (k, 3) unit directions in which the moving side is blocked; that of the first side if both move.
    """

    points: Floats
    blocked: Floats


def contacts_of(edit: BlenderEdit | CulledEdit, result: stiv.EditResult) -> Contacts:
    """Contacts that the last call of an edit found, at its accepted surface."""
    moving = np.zeros(len(edit.surface), np.bool_)
    for index in (index for control_set in edit.control_sets for index in control_set.surfaces):
        moving[edit.assembly.vertices(index)] = True
    return contacts_at(result.events, edit.surface, moving)


def contacts_at(events: stiv.Events, surface: Floats, moving: NDArray[np.bool_]) -> Contacts:
    """Contacts of events at surface positions, (N, 3); `moving`, (N,), flags the vertices that may move.

    Positive weights of an event give the point on its first side, negative ones that on its second side. The normal
    points in the direction in which the first side is pushed.
    """
    count = len(events.kind)
    chosen = np.unique(np.linspace(0, count - 1, min(count, MAX_CONTACTS)).astype(int))
    vertices, weights = events.vertices[chosen], events.weights[chosen]
    corners = surface[vertices]
    first = np.einsum("kc,kcx->kx", np.maximum(weights, 0), corners)
    second = np.einsum("kc,kcx->kx", np.maximum(-weights, 0), corners)
    first_moves = (moving[vertices] & (weights > 0)).any(axis=1)
    blocked = np.where(first_moves[:, None], -events.normal[chosen], events.normal[chosen])
    return Contacts((first + second) / 2, blocked)


def triangles_of(context: bpy.types.Context, pairs: Sequence[FacePair]) -> Floats:
    """Triangles, (t, 3, 3), of all faces in the pairs, as Blender shows them now."""
    faces: dict[str, set[int]] = {}
    for element in (each for pair in pairs for each in (pair.first, pair.second)):
        if element.kind == "face" and element.evaluation == SHOWN:
            faces.setdefault(element.object, set()).add(element.number)
    found = [np.empty((0, 3, 3))]
    for mesh in read_scene(context, lambda name: name in faces).meshes:
        wanted = np.isin(mesh.faces, list(faces[mesh.owner.name]))
        found.append(mesh.world()[mesh.triangles[wanted]])
    return np.concatenate(found)
