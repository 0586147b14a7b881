# SPDX-License-Identifier: GPL-3.0-or-later
"""Why an edit moved nothing: contact with other objects, or locks of the location."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import bpy
import numpy as np

import stiv
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.controls.transform_locks import location_lock_text
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.elements import PART
from stiv.blender.scene.message_fitting import first_and_others, fit_message

ROUNDING = 1e-6  # of the way to the goal: what a state that is accepted in contact may differ from the start


def contact_text(
    result: stiv.EditResult, assembly: Assembly, moving: Collection[str], ways: tuple[Floats, Floats]
) -> str:
    """The message on contact that let nothing move; "" if something has moved, or the contact is not known.

    ways: from the start to the accepted controls and to the goal, (m, 3) each.
    """
    made, wanted = (float(np.abs(way).max(initial=0.0)) for way in ways)
    names = objects_in_contact(result, assembly, moving)
    if result.status != "corrected" or made > ROUNDING * wanted or not names:
        return ""
    return fit_message("nothing moved: already in contact with {}{}", *first_and_others(names))


def objects_in_contact(result: stiv.EditResult, assembly: Assembly, moving: Collection[str]) -> list[str]:
    """Names of the objects in contact, those that do not move if there are any."""
    surface, vertices = assembly.surface, np.unique(result.events.vertices)
    count = int(np.searchsorted(vertices, surface.vertex_count))  # vertices of obstacles follow those of the surface
    bodies = np.unique(surface.vertex_body[vertices[:count]])
    ends = np.cumsum([each.vertex_count for each in assembly.obstacles])
    obstacles = np.unique(np.searchsorted(ends, vertices[count:] - surface.vertex_count, side="right"))
    names = {surface.bodies[number].name.partition(PART)[0] for number in bodies.tolist()}
    names |= {assembly.obstacles[number].owner.name for number in obstacles.tolist()}
    return sorted(names - set(moving)) or sorted(names)


def lock_text(control_sets: Sequence[ControlSet]) -> str:
    """The message on the first moving object whose location is locked along some axes; "" without any."""
    moving = (each for each in control_sets if each.rule.moves and each.role == "rigid")
    objects = (bpy.data.objects.get(name) for each in moving for name in each.names)
    return next((location_lock_text(ob) for ob in objects if ob is not None and any(ob.lock_location)), "")
