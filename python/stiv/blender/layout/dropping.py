# SPDX-License-Identifier: GPL-3.0-or-later
"""Drops objects until they rest, and settles them into contact."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import bpy
import numpy as np

from stiv import InputError
from stiv.blender.layout.layout_edit import GROUND, LayoutEdit
from stiv.blender.layout.layout_task import LayoutReport, LayoutTask, Watch, run
from stiv.blender.layout.parting import part
from stiv.blender.layout.resting import Rest, rest
from stiv.blender.layout.rigid_contacts import find_intersected, find_nearest
from stiv.blender.scene.arrays import Floats
from stiv.blender.settings import EditSettings
from stiv.task import Steps

MAX_PASSES = 4  # over the objects: one may have rested on another that then fell
GRAVITY = (0.0, 0.0, -1.0)


@dataclass(frozen=True)
class DropSettings:
    """How `drop` works.

    Attributes:
        edit: the minimum distances, roles and guard; its time_budget limits the whole drop.
        direction: in which objects fall, world space; None: the scene's gravity.
        turn: turn and slide until three contacts support the object; otherwise it stops on the line.
        ground: objects with nothing below fall on the plane z = 0.
    """

    edit: EditSettings = field(default_factory=EditSettings)
    direction: tuple[float, float, float] | None = None
    turn: bool = True
    ground: bool = False


@dataclass(frozen=True)
class SettleSettings:
    """How `settle_into_contact` works.

    Attributes:
        edit: the minimum distances, roles and guard; its time_budget limits the whole call.
        direction: in which objects move, world space; None: toward the nearest surface of each.
        turn: turn and slide until three contacts support the object.
        max_distance: no object moves further than this; 0: the size of the object.
    """

    edit: EditSettings = field(default_factory=EditSettings)
    direction: tuple[float, float, float] | None = None
    turn: bool = True
    max_distance: float = 0.0


class Drop(LayoutTask):
    """Drops the selected objects: lower ones first, and the others onto them."""

    def __init__(self, context: bpy.types.Context, settings: DropSettings) -> None:
        """Read the scene. Raises InputError, also if an object intersects another at the start."""
        super().__init__(settings.edit.time_budget)
        self._settings = settings
        self._direction = unit_vector(settings.direction or gravity(context.scene))
        self._edit = LayoutEdit(context, settings.edit, context.selected_objects, settings.ground)
        self._rests: dict[int, Rest] = {}

    def _solve(self, watch: Watch) -> Steps[None]:
        scene, count = self._edit.scene, len(self._edit.control_sets)
        yield from check_start(self._edit, watch)
        order = sorted(range(count), key=lambda k: -float((scene.positions_of(k) @ self._direction).max()))
        for number in range(MAX_PASSES):
            moved = False
            for done, mover in enumerate(order):
                yield from watch.at(scene.movers[mover].name, (done + number * count) / (MAX_PASSES * count))
                found = yield from self._drop(mover, watch)
                before = self._rests.get(mover)
                moved |= found.distance > scene.separation
                if before is None or found.status == "rests":
                    self._rests[mover] = found
            if not moved or count == 1:
                break

    def _drop(self, mover: int, watch: Watch) -> Steps[Rest]:
        scene = self._edit.scene
        if self._settings.ground:
            above = scene.box(mover)[0, 2] > 0 and self._direction[2] < 0
            scene.leave_out([] if above else [len(scene.movers) - 1])
        if np.linalg.norm(scene.movers[mover].along_free(self._direction) - self._direction) > 1e-6:
            return Rest("locked")
        return (yield from rest(scene, mover, self._direction, watch, turn=self._settings.turn))

    def _write(self) -> LayoutReport:
        return write_rests(self._edit, self._rests, "nothing below")

    def restore(self) -> None:
        """Restore the objects exactly."""
        self._edit.restore()


class SettleIntoContact(LayoutTask):
    """Moves the selected objects into contact with the nearest surfaces, and turns them until they are supported."""

    def __init__(self, context: bpy.types.Context, settings: SettleSettings) -> None:
        """Read the scene. Raises InputError."""
        super().__init__(settings.edit.time_budget)
        self._settings = settings
        self._edit = LayoutEdit(context, settings.edit, context.selected_objects)
        self._rests: dict[int, Rest] = {}

    def _solve(self, watch: Watch) -> Steps[None]:
        scene, count = self._edit.scene, len(self._edit.control_sets)
        for mover in range(count):
            yield from watch.at(scene.movers[mover].name, mover / count)
            self._rests[mover] = yield from self._settle(mover, watch)

    def _settle(self, mover: int, watch: Watch) -> Steps[Rest]:
        scene, start = self._edit.scene, self._edit.scene.pose(mover)
        limit = self._settings.max_distance or scene.size(mover)
        if find_intersected(scene, mover) and (yield from part(scene, mover, watch)) is None:
            return Rest("nothing")
        if self._settings.direction is not None:
            direction = unit_vector(self._settings.direction)
        else:
            near = find_nearest(scene, mover)
            if near is None or np.linalg.norm(near[0]) > limit:
                scene.set_pose(mover, start)
                return Rest("nothing")
            direction = unit_vector(near[0])
        if np.linalg.norm(scene.movers[mover].along_free(direction) - direction) > 1e-6:
            scene.set_pose(mover, start)
            return Rest("locked")
        found = yield from rest(scene, mover, direction, watch, limit, turn=self._settings.turn)
        if found.status == "nothing":  # it would slide off: the straight stop alone
            found = yield from rest(scene, mover, direction, watch, limit, turn=False)
        if found.status == "nothing":
            scene.set_pose(mover, start)
        return found

    def _write(self) -> LayoutReport:
        return write_rests(self._edit, self._rests, "nothing near")

    def restore(self) -> None:
        """Restore the objects exactly."""
        self._edit.restore()


def check_start(edit: LayoutEdit, watch: Watch) -> Steps[None]:
    """Steps that raise InputError naming the first mover that intersects something."""
    for number in range(len(edit.control_sets)):
        yield from watch.check()
        other = find_intersected(edit.scene, number)
        if other and other != GROUND:
            raise InputError(f"{edit.scene.movers[number].name}: intersects {other}; use Push Apart")


def write_rests(edit: LayoutEdit, rests: dict[int, Rest], nothing: str) -> LayoutReport:
    """Write the poses of movers that rest; `nothing` is the reason of those without support."""
    reasons = {"nothing": nothing, "locked": "locked"}
    names = [mover.name for mover in edit.scene.movers]
    left = [(names[k], reasons[each.status]) for k, each in rests.items() if each.status in reasons]
    left += [(name, "no surface") for name in edit.without_surface]
    changed = [k for k in rests if edit.has_moved(k)]
    if changed:
        edit.write()
    return LayoutReport(
        "done" if changed else "unchanged",
        tuple(names[k] for k in changed),
        tuple(left),
        tuple(len(rests[k].contacts) for k in changed),
        len(rests),
    )


def gravity(scene: bpy.types.Scene) -> tuple[float, float, float]:
    """The direction of the scene's gravity; down if it is off."""
    vector = tuple(scene.gravity) if scene.use_gravity else GRAVITY
    return vector if any(vector) else GRAVITY


def unit_vector(vector: Floats | tuple[float, ...]) -> Floats:
    """The vector with length 1. Raises InputError for a vector that has none."""
    found = np.asarray(vector, np.float64)
    length = float(np.linalg.norm(found))
    if found.shape != (3,) or not 0 < length < np.inf:
        raise InputError(f"direction: {vector!r} is not a direction")
    return found / length


def drop(context: bpy.types.Context, settings: DropSettings | None = None, **execution: Any) -> LayoutReport:
    """Drop the selected objects until they rest.

    `cancel` and `progress` are those of stiv.EditSession. Raises InputError, with nothing changed.
    """
    return run(Drop(context, settings or DropSettings()), **execution)


def settle_into_contact(
    context: bpy.types.Context, settings: SettleSettings | None = None, **execution: Any
) -> LayoutReport:
    """Move the selected objects by the least motion until they touch the nearest surfaces, and rest there.

    Raises InputError, with nothing changed.
    """
    return run(SettleIntoContact(context, settings or SettleSettings()), **execution)
