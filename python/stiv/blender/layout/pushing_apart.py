# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves objects apart that intersect or are nearer than the minimum distance."""

from __future__ import annotations

from typing import Any

import bpy

from stiv.blender.layout.layout_edit import LayoutEdit
from stiv.blender.layout.layout_task import LayoutReport, LayoutTask, Watch, run
from stiv.blender.layout.parting import part_all
from stiv.blender.settings import EditSettings
from stiv.task import Steps


class PushApart(LayoutTask):
    """Translates the selected objects by the least distances found until they are apart."""

    def __init__(self, context: bpy.types.Context, settings: EditSettings) -> None:
        """Read the scene; its time_budget limits the whole call. Raises InputError."""
        super().__init__(settings.time_budget)
        self._edit = LayoutEdit(context, settings, context.selected_objects)
        self._left: list[int] = []

    def _solve(self, watch: Watch) -> Steps[None]:
        self._left = yield from part_all(self._edit.scene, range(len(self._edit.control_sets)), watch)

    def _write(self) -> LayoutReport:
        names = [mover.name for mover in self._edit.scene.movers]
        left = [(names[k], "stuck") for k in self._left]
        left += [(name, "no surface") for name in self._edit.without_surface]
        if self._left:
            return LayoutReport("unchanged", left=tuple(left), asked=len(names))
        changed = tuple(name for k, name in enumerate(names) if self._edit.has_moved(k))
        if changed:
            self._edit.write()
        return LayoutReport("done" if changed else "unchanged", changed, tuple(left), asked=len(names))

    def restore(self) -> None:
        """Restore the objects exactly."""
        self._edit.restore()


def push_apart(context: bpy.types.Context, settings: EditSettings | None = None, **execution: Any) -> LayoutReport:
    """Move the selected objects apart, from each other and from everything else, without turning them.

    `cancel` and `progress` are those of stiv.EditSession. Raises InputError, with nothing changed.
    """
    return run(PushApart(context, settings or EditSettings()), **execution)
