# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds all data-blocks that depend on others, from the references that Blender itself lists."""

from __future__ import annotations

from collections.abc import Iterable

import bpy


class DataUsers:
    """The users of all data-blocks of the file; valid until objects are added, removed or changed.

    Blender lists every reference: parents, constraints, modifiers, inputs and nodes, drivers, collections, custom
    properties. Some of them have no effect, so that the users of a data-block are too many rather than too few.
    """

    def __init__(self) -> None:
        self._users: dict[bpy.types.ID, set[bpy.types.ID]] = bpy.data.user_map()
        for ob in bpy.data.objects:
            if ob.parent is not None and ob.parent.instance_type in ("VERTS", "FACES"):  # it shows its children
                self._users.setdefault(ob, set()).add(ob.parent)

    @property
    def all(self) -> Iterable[bpy.types.ID]:
        """All data-blocks."""
        return self._users.keys()

    def with_dependents(self, start: Iterable[bpy.types.ID]) -> set[bpy.types.ID]:
        """These data-blocks, and all that refer to them directly or indirectly."""
        found = set(start)
        waiting = list(found)
        while waiting:
            new = self._users.get(waiting.pop(), set()) - found
            found |= new
            waiting += new
        return found
