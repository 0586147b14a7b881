# SPDX-License-Identifier: GPL-3.0-or-later
"""An edit for drags in large scenes: obstacles, and parts of large ones, are taken in when what moves comes near."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import bpy
import numpy as np
from numpy.typing import ArrayLike

import stiv
from stiv.blender.controls.motion import Motion
from stiv.blender.controls.participants import find_movers
from stiv.blender.edit.blender_edit import BlenderEdit
from stiv.blender.edit.state_writer import WriteReport
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.culling import Reach, find_reach
from stiv.blender.settings import EditSettings, check_kind

MOST_WIDENINGS = 4  # then all obstacles are taken in, so that it ends


def begin_nearby(context: bpy.types.Context, settings: EditSettings, kind: str) -> NearbyEdit | BlenderEdit:
    """An edit as of `BlenderEdit.begin`; in a large scene without the obstacles, and parts of them, that are far yet.

    Raises what that one raises.
    """
    check_kind(kind)
    movers = find_movers(context, settings)
    reach = find_reach(context, movers, settings)
    if reach is None:
        return BlenderEdit.begin_with(context, settings, kind, movers)
    return NearbyEdit(context, settings, kind, reach)


class NearbyEdit:
    """A BlenderEdit among the obstacles within a reach; everything that is not told here is that of the edit within.

    What it accepts stays within the reach, so that it meets nothing of what is left out. As soon as a goal or a
    solution leaves the reach, an edit with a wider one goes on from the state shown last.
    """

    def __init__(self, context: bpy.types.Context, settings: EditSettings, kind: str, reach: Reach) -> None:
        """Use `begin_nearby`."""
        self._settings, self._kind = settings, kind
        self._reach: Reach | None = reach
        movers = find_movers(context, settings)
        self._edit = BlenderEdit.begin_with(context, settings, kind, movers, reach=reach)
        self._shown = self._edit.controls
        self._widened = 0

    def __getattr__(self, name: str) -> Any:
        """Whatever else an edit has."""
        return getattr(self._edit, name)

    @property
    def has_all(self) -> bool:
        """Are all obstacles taken in?"""
        return self._reach is None

    def drag(self, motion: Motion | ArrayLike, **execution: Any) -> stiv.EditResult:
        """As of BlenderEdit."""
        goal = self._edit.goal_of(motion)
        if self._edit.interference and not self._within([goal]):
            self._widen([goal])
        result = self._edit.drag(motion, **execution)
        while not self._stays(result):
            self._widen([goal, *result.path, result.controls])
            result = self._edit.drag(motion, **execution)
        return result

    def settle(self, **execution: Any) -> stiv.EditResult:
        """As of BlenderEdit."""
        goal = self._edit.goal
        result = self._edit.settle(**execution)
        while not self._stays(result):
            self._widen([goal, *result.path, result.controls])
            result = self._edit.drag_to(goal, **execution)
        return result

    def set_interference(self, on: bool) -> str:
        """As of BlenderEdit. While it is off surfaces may go anywhere."""
        self._go_on_within(None)
        return self._edit.set_interference(on)

    def write(self) -> WriteReport:
        """As of BlenderEdit."""
        report = self._edit.write()
        self._shown = self._edit.controls
        if report.result is not None:  # solved again, by a way that was not looked at
            self._go_on_within(None)
        return report

    def restore(self) -> None:
        """As of BlenderEdit."""
        self._edit.restore()
        self._shown = self._edit.controls

    def _stays(self, result: stiv.EditResult) -> bool:
        return not self._edit.interference or self._within([*result.path, result.controls])

    def _within(self, places: Iterable[Floats]) -> bool:
        return self._reach is None or all(self._reach.contains(self._edit.moving_points(place)) for place in places)

    def _widen(self, places: Iterable[Floats]) -> None:
        """Go on within a reach around the last one and these places; after a few times, among all obstacles."""
        if self._reach is None:
            return
        corners = np.stack([self._reach.low, self._reach.high])
        beyond = np.concatenate([corners, *(self._edit.moving_points(place) for place in places)])
        self._widened += 1
        movers = find_movers(bpy.context, self._settings)
        few = self._widened <= MOST_WIDENINGS
        self._go_on_within(find_reach(bpy.context, movers, self._settings, beyond) if few else None)

    def _go_on_within(self, reach: Reach | None) -> None:
        """Begin again among the obstacles of a reach, None for all, and go on from the state shown last."""
        if self._reach is None:
            return
        shown = self._shown
        self._edit.restore()
        movers = find_movers(bpy.context, self._settings)
        self._edit = BlenderEdit.begin_with(bpy.context, self._settings, self._kind, movers, reach=reach)
        self._reach = reach
        if self._edit.take_up(shown):
            self._edit.write()
        self._shown = self._edit.controls
