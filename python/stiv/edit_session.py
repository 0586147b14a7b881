# SPDX-License-Identifier: GPL-3.0-or-later
"""Editing sessions: move the controls of a surface, and get the closest state without intersections."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv import _native
from stiv._native import CancelToken, Deformation
from stiv.arrays import Indices
from stiv.detection import Events
from stiv.distances import LeastDistance, least_distance_of
from stiv.edit_options import (
    EditOptions,
    StorageFrame,
    as_doubles,
    as_weight_axes,
    as_weights,
    native_options,
    with_numbers,
)
from stiv.intersections import DeviationTest
from stiv.job import Job
from stiv.obstacles import Obstacle
from stiv.surface import Surface, as_surface

__all__ = ["CancelToken", "EditOptions", "EditResult", "EditSession", "StorageFrame", "edit"]

Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class EditResult:
    """Result of an edit."""

    #: "reached" (the goal itself), "corrected" (short of it: interference was resolved, or a limit of `stiv.scalars`
    #: holds), "blocked" (stopped at the last clear state), "budget" (out of time), "cancelled" (the state before the
    #: edit), or "unchanged" (nothing to do)
    status: str
    controls: NDArray[np.float64]  #: (m, 3) accepted controls, as stored
    surface: NDArray[np.float64]  #: (N, 3) surface of these controls, world coordinates
    #: half the sum of squared distances to the surface of the goal; if the goal has none (`stiv.observed`), to that of
    #: the last point before it
    energy: float
    fraction: float  #: minimum accepted fraction of a step
    rounds: int  #: detections followed by a response
    events: Events  #: contacts of the last round with contacts
    patches: int  #: number of contact patches in that round
    blocking: tuple[str, ...]  #: names of the bodies in contact when blocked, each once
    timings: dict[str, float]  #: seconds of each stage of the pipeline, and "total"
    #: counts of work, independent of the machine; "infeasible" counts goals and candidates without a surface
    counters: dict[str, int]
    #: accepted controls in order, the last of them `controls`; the linear motion of the surface between two of them is
    #: free of intersections
    path: list[NDArray[np.float64]] = field(default_factory=list)


def result_of(values: dict[str, Any], surface: Surface, obstacles: Sequence[Obstacle] = ()) -> EditResult:
    """Return the result of an edit from the values of the core."""
    names = [*(body.name for body in surface.bodies), *(each.name for each in obstacles)]
    values["events"] = Events(*values["events"])
    values["blocking"] = tuple(dict.fromkeys(names[body] for body in values["blocking"]))
    return EditResult(rounds=values["counters"]["rounds"], **values)


class EditSession:
    """A surface, the deformation that moves it, and the last accepted controls.

    Every accepted state is free of intersections, and so is the path to it from the previous one. A session accepts one
    call at a time; sessions are independent of each other. Solving releases the interpreter lock. Methods whose name
    begins with ``start`` return a :class:`stiv.Job`; until it is done, other calls of the session raise InputError.

    A start that intersects is rejected, unless the intersecting pairs are excluded (`EditOptions.exclude`). Then the
    number of excluded pairs that intersect never grows, and no other pair ever intersects; see :attr:`excluded`. The
    volume that two closed bodies share never exceeds that at the start of the session. The same holds for the area of
    an open body inside a closed one, with the triangles' areas at the start. The depth of excluded pairs of two open
    bodies, or of one body, has no limit, but collisions of neighboring triangles stop them from passing through each
    other. Parts of one body that only touch at the start never intersect deeper than rounding. Bodies that always
    intersect should be `ignored` pairs of the surface. Exclusion would almost fix them to each other, because other
    triangles would intersect.

    Args:
        surface: triangles, (F, 3) integers, or a :class:`stiv.Surface`.
        deformation: the map from controls to surface positions.
        controls: (m, 3) controls at the start, world coordinates.
        options: how edits are solved.
        obstacles: large bodies that never move. Only their triangles near the motion are read, so time and memory of a
            call do not grow with the others. Numbers of vertices, triangles and bodies continue after those of the
            surface. Their pairs cannot be excluded, and they cannot overlap bodies (`EditOptions.overlapping`).

    Raises:
        InputError: invalid shapes or values; the message names object and element.
        StartIntersectsError: the start intersects itself; ``pairs`` lists the triangles.
    """

    def __init__(
        self,
        surface: Surface | ArrayLike,
        deformation: Deformation,
        controls: ArrayLike,
        options: EditOptions | None = None,
        obstacles: Sequence[Obstacle] = (),
    ) -> None:
        self._topology, *given = _native_arguments(surface, deformation, controls, options, obstacles)
        self._obstacles = tuple(obstacles)
        self._session = _native.EditSession(self._topology.native, *given)

    @classmethod
    def start(
        cls,
        surface: Surface | ArrayLike,
        deformation: Deformation,
        controls: ArrayLike,
        options: EditOptions | None = None,
        obstacles: Sequence[Obstacle] = (),
    ) -> Job[EditSession]:
        """Start making a session, as a job; the arguments are those of the class."""
        topology, *given = _native_arguments(surface, deformation, controls, options, obstacles)

        def wrap(native: _native.EditSession) -> EditSession:
            session = cls.__new__(cls)
            session._topology, session._obstacles, session._session = topology, tuple(obstacles), native
            return session

        return Job(_native.EditSession.start(topology.native, *given), wrap)

    @property
    def controls(self) -> NDArray[np.float64]:
        """Accepted controls, (m, 3)."""
        return self._session.controls

    @property
    def surface(self) -> NDArray[np.float64]:
        """Surface of the accepted controls, (N, 3)."""
        return self._session.surface

    @property
    def separation(self) -> float:
        """Minimum distance between surfaces, world units."""
        return self._session.separation

    @property
    def excluded(self) -> Indices:
        """Pairs of triangles that may intersect, (k, 2), smaller index first, in lexicographic order.

        Those of the options, and other pairs of the same bodies that touch at the start. Two triangles touch if they
        are apart, but nearer than coordinates can keep them. Neighbors of the former may then intersect; the others no
        deeper than rounding.
        """
        return self._session.excluded

    def least_distance(self, *, within: bool = False) -> LeastDistance | None:
        """Return the least distance between bodies in the accepted state; ``within``: and within bodies.

        See :func:`stiv.least_distance`.
        """
        return least_distance_of(self._session.least_distance(within), self._topology, self._obstacles)

    def is_step_free(self, start: ArrayLike, end: ArrayLike) -> bool:
        """Return whether the linear step between two surfaces, (N, 3) each, is free, along its path and at its end.

        `start` must be free. Works like :meth:`stiv.StepCheck.is_free`, with the trees of the session, and does not
        test the accepted surface again. Not for sessions with excluded pairs.
        """
        return self._session.is_step_free(as_doubles(start, "start"), as_doubles(end, "end"))

    def deviation_test(self, threads: int = 0) -> DeviationTest | None:
        """Return the exact test of surfaces that deviate from the accepted one by rounding, such as evaluated ones.

        It remains valid, and may be used while the session solves on. None for sessions with excluded pairs, bodies
        that may overlap or obstacles, and where the accepted state was not the last that was tested.
        """
        native = self._session.deviation_test()
        return None if native is None else DeviationTest(native, threads)

    def edit(
        self, goal: ArrayLike, *, cancel: CancelToken | None = None, progress: Progress | None = None
    ) -> EditResult:
        """Edit from the accepted controls toward ``goal``, (m, 3).

        ``cancel.cancel()``, from another thread or from ``progress``, ends the edit within milliseconds, with the state
        before the edit. ``progress(phase, fraction)`` is called between rounds. An exception in it cancels the edit and
        is raised again.
        """
        return self._result(self._session.edit(as_doubles(goal, "goal"), cancel, progress))

    def drag(
        self,
        goal: ArrayLike,
        *,
        cancel: CancelToken | None = None,
        progress: Progress | None = None,
        time_budget: float | None = None,
        hand_over: float | None = None,
    ) -> EditResult:
        """Solve one mouse move of a drag toward the absolute ``goal``, (m, 3).

        A drag first applies the increment since the previous goal, then pulls toward the rest of the goal. So goals
        deep inside an obstacle neither lose motion nor drag sideways, and the shape returns with the mouse.

        ``time_budget``, in seconds, replaces that of the options. If it ends a call before anything is accepted, the
        next call with the same goal continues. Another goal starts again with the whole increment.

        ``hand_over``, in seconds: the call ends at the first state that it accepts after this time, with the status
        "budget", so that the state can be shown while the next call continues from it. The call then begins with the
        contacts of the last one, and its increment includes a part of a pull.
        """
        values = self._session.drag(as_doubles(goal, "goal"), cancel, progress, time_budget, hand_over)
        return self._result(values)

    def settle(self, *, cancel: CancelToken | None = None, progress: Progress | None = None) -> EditResult:
        """Solve again toward the last goal until the energy no longer falls. It never grows.

        Without a time budget, also does what :meth:`confirm` does.
        """
        return self._result(self._session.settle(cancel, progress))

    def confirm(self, *, cancel: CancelToken | None = None, progress: Progress | None = None) -> EditResult:
        """After a straight drag to a far goal, make the edit from its start as well, and keep the better result.

        For a drag with time budgets that has settled, when the user waits or rests. Heeds no time budget.
        """
        return self._result(self._session.confirm(cancel, progress))

    def start_edit(self, goal: ArrayLike) -> Job[EditResult]:
        """Start :meth:`edit` as a job."""
        return self._job(self._session.start_edit(as_doubles(goal, "goal")))

    def start_drag(
        self, goal: ArrayLike, *, time_budget: float | None = None, hand_over: float | None = None
    ) -> Job[EditResult]:
        """Start :meth:`drag` as a job."""
        return self._job(self._session.start_drag(as_doubles(goal, "goal"), time_budget, hand_over))

    def start_settle(self) -> Job[EditResult]:
        """Start :meth:`settle` as a job."""
        return self._job(self._session.start_settle())

    def start_confirm(self) -> Job[EditResult]:
        """Start :meth:`confirm` as a job."""
        return self._job(self._session.start_confirm())

    def end_drag(self) -> None:
        """Free what is prepared for further calls of a drag, and pages that the heap does not use (glibc).

        Calls remain possible.
        """
        self._session.end_drag()

    def _job(self, native: _native.Job) -> Job[EditResult]:
        return Job(native, self._result)

    def _result(self, values: dict[str, Any]) -> EditResult:
        return result_of(values, self._topology, self._obstacles)

    def restore(self, controls: ArrayLike, goal: ArrayLike | None = None) -> None:
        """Restore ``controls``, (m, 3), that were accepted earlier (undo, cancel).

        ``goal``, (m, 3), becomes the goal of the last drag, where the increment of the next drag starts; None: the
        controls. Later edits do not depend on earlier ones.

        Raises:
            StartIntersectsError: the surface intersects itself; the session is unchanged.
        """
        toward = None if goal is None else as_doubles(goal, "goal")
        self._session.restore(as_doubles(controls, "controls"), toward)

    def set_weights(self, weights: ArrayLike | None, weight_axes: ArrayLike | None = None) -> None:
        """Change the response weights and their axes, as in :class:`stiv.EditOptions`.

        Continues from the accepted state as after :meth:`restore`. Raises InputError, with nothing changed.
        """
        self._session.set_weights(as_weights(weights), as_weight_axes(weight_axes))


def _native_arguments(
    surface: Surface | ArrayLike,
    deformation: Deformation,
    controls: ArrayLike,
    options: EditOptions | None,
    obstacles: Sequence[Obstacle],
) -> tuple[Any, ...]:
    """Return the surface, then the other arguments of the core."""
    topology = as_surface(surface, deformation.vertex_count)
    start = as_doubles(controls, "controls")
    names = [each.name for each in obstacles]
    chosen = with_numbers(options or EditOptions(), topology, lambda: deformation.surface(start), names)
    return topology, deformation, start, native_options(chosen), [each.native for each in obstacles]


def edit(
    surface: Surface | ArrayLike,
    deformation: Deformation,
    controls: ArrayLike,
    goal: ArrayLike,
    options: EditOptions | None = None,
) -> EditResult:
    """The one-off form of :meth:`EditSession.edit`."""
    return EditSession(surface, deformation, controls, options).edit(goal)
