# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves values of shape keys toward goals, and stops where surfaces touch."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import bpy
import numpy as np

from stiv.blender.morphing.key_sliders import KeySlider, find_sliders
from stiv.blender.morphing.morph_edit import MorphEdit
from stiv.blender.morphing.morph_session import SliderLimits
from stiv.blender.morphing.morphed_scene import MorphedScene
from stiv.blender.scene.arrays import Flags, Floats
from stiv.blender.scene.deferred_meshes import compute_meshes_steps
from stiv.blender.settings import EditSettings
from stiv.task import Steps, run


@dataclass(frozen=True)
class MorphReport:
    """The result of a morph.

    Attributes:
        status: of stiv.EditResult.
        values: (object, key) and its value now, of each slider that was read.
        blocking: names of the objects in contact when blocked.
        start_notes: about objects that intersect themselves at the start, and about excluded pairs.
        torn_seam_note: about faces at torn seams that cut each other now; "" without any.
    """

    status: str
    values: Mapping[tuple[str, str], float]
    blocking: tuple[str, ...] = ()
    start_notes: tuple[str, ...] = ()
    torn_seam_note: str = ""


def morph(
    context: bpy.types.Context,
    values: Mapping[str, Mapping[str, float]],
    settings: EditSettings,
    *,
    others_yield: bool = False,
) -> MorphReport:
    """Move values of shape keys toward goals, and write the closest ones without intersections.

    Blender evaluates the scene, so groups, relative keys, muted keys, modifiers and objects that follow the shape have
    their effect. Goals beyond the range of a slider end at it. No given slider passes its goal. All other objects stay,
    but clothes yield with `responders` "unselected" or "all": objects with their own deformation, or role "controls".
    Keyframes are inserted if Auto Keying is on.

    values        goals by names of object and key, such as {"Body": {"Wide": 1.0}}
    settings      as of an edit in Object Mode; object_response and slide_out_of_axis have no effect. time_budget limits
                  the way to the goals, which then ends early with the status "budget"
    others_yield  the other sliders of these objects respond too, so that the given ones come closer to their goals

    Raises InputError naming object and key, StartIntersectsError if objects intersect at the start; nothing changed.
    """
    return run(MorphTask(context, values, settings, others_yield=others_yield).solve_steps())


class MorphTask:
    """A morph in steps, which write its result. Reading and writing require Blender's main thread."""

    def __init__(
        self,
        context: bpy.types.Context,
        values: Mapping[str, Mapping[str, float]],
        settings: EditSettings,
        *,
        others_yield: bool = False,
    ) -> None:
        """Find the sliders. The arguments are those of `morph`. Raises InputError."""
        self._context, self._settings = context, settings
        self._sliders, goals, given = find_sliders(values, others_yield)
        self._goals = np.array(goals)
        self._limits = limits_toward(self._sliders, self._goals, np.array(given), others_yield)
        self._scene: MorphedScene | None = None

    def solve_steps(self) -> Steps[MorphReport]:
        """Steps of `morph`. If they raise or are closed, the scene shows the start.

        Between steps, and while a job solves, the scene may show values that intersect: call `write_tested`.
        """
        yield from compute_meshes_steps(self._context)
        scene = self._scene = MorphedScene(self._context, self._settings, self._sliders)
        yield None
        edit = yield from MorphEdit.begin_in_steps(scene, self._sliders, self._limits)
        try:
            report = yield from _solve_steps(edit, self._goals, self._settings.time_budget)
        except BaseException:
            edit.restore()
            raise
        edit.insert_keyframes(self._context)
        return report

    def write_tested(self) -> None:
        """Write the last values that passed the test, which are those of the start until the last step."""
        if self._scene is not None:
            self._scene.write_tested()

    def restore(self) -> None:
        """Restore the start exactly."""
        if self._scene is not None:
            self._scene.restore()


def limits_toward(
    sliders: Sequence[KeySlider], goals: Floats, given: Flags, others_yield: bool = False
) -> SliderLimits:
    """Limits, (k,) each, within which no given slider passes its goal."""
    start, least, most = (np.array([getattr(s, name) for s in sliders]) for name in ("start", "lower", "upper"))
    nearest = np.clip(goals, least, most)
    lower = np.where(given, np.minimum(start, nearest), least)
    return SliderLimits(given, lower, np.where(given, np.maximum(start, nearest), most), others_yield)


def _solve_steps(edit: MorphEdit, goals: Floats, time_budget: float) -> Steps[MorphReport]:
    """Steps that move sliders toward goals, and leave the scene at the closest values that Blender shows free."""
    result, arrived = yield from edit.advance_steps(goals, time_budget or np.inf)
    settled = (yield from edit.settle_steps()) if arrived else result
    yield None
    edit.show()
    status = settled.status if settled.status != "unchanged" else result.status
    if not arrived:
        status = "budget"
    elif np.array_equal(edit.values, edit.start) and status != "unchanged":
        status = "blocked"
    values = dict(zip([(each.owner.name, each.key) for each in edit.sliders], edit.values.tolist(), strict=True))
    blocking = result.blocking or settled.blocking
    return MorphReport(status, values, blocking, edit.start_notes, edit.torn_seam_note)
