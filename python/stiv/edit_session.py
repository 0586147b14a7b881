# SPDX-License-Identifier: GPL-3.0-or-later
"""Editing sessions: drag what deforms a surface, and get the nearest state that goes through nothing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv import _native
from stiv._native import CancelToken, Deformation
from stiv.detection import Events
from stiv.distances import LeastDistance, least_distance_of
from stiv.edit_options import EditOptions, StorageFrame, as_doubles, native_options, with_numbers
from stiv.surface import Surface, as_surface

__all__ = ["CancelToken", "EditOptions", "EditResult", "EditSession", "StorageFrame", "edit"]

Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class EditResult:
    """What an edit came to."""

    #: "reached" (the goal itself), "corrected" (interference was resolved), "blocked" (stopped at the last clear
    #: state), "budget" (the time was used up), "cancelled" (the state before), or "unchanged" (nothing to do)
    status: str
    controls: NDArray[np.float64]  #: (m, 3) accepted controls, as stored
    surface: NDArray[np.float64]  #: (N, 3) the surface that they give, world coordinates
    energy: float  #: half the sum of squared distances to the goal's surface
    fraction: float  #: least fraction of a step that was accepted
    rounds: int  #: detections that were followed by a response
    events: Events  #: contacts of the last round that had any
    patches: int  #: their number of patches
    blocking: tuple[str, ...]  #: names of the bodies in contact when blocked
    timings: dict[str, float]  #: seconds by step of the pipeline, and "total"
    counters: dict[str, int]  #: what was done, independent of the machine
    #: controls accepted on the way, the last of them `controls`: between two of them the surface moves on straight
    #: lines and meets nothing
    path: list[NDArray[np.float64]] = field(default_factory=list)


def result_of(values: dict[str, Any], surface: Surface) -> EditResult:
    """Return the core's account of an edit as a result."""
    values["events"] = Events(*values["events"])
    values["blocking"] = tuple(surface.bodies[body].name for body in values["blocking"])
    return EditResult(rounds=values["counters"]["rounds"], **values)


class EditSession:
    """A surface, the deformation that moves it, and the controls accepted last.

    Every accepted state is free of intersections, and reachable from the one before without passing through. A session
    serves one call at a time; sessions are independent of each other. The interpreter lock is released while solving.

    A start that already intersects is refused, unless the pairs that do are excluded (`EditOptions.exclude`). Then,
    from one accepted state to the next, the number of excluded pairs that intersect never grows, and no other pair
    ever intersects; two closed bodies never have more volume in common than at the start of the session, and of an
    open body no more area is inside of a closed one, each triangle counted with its area at the start. How deep
    excluded pairs of two open bodies, or of one body, go is not watched; but the neighbours of their triangles are
    guarded, so that they cannot go on through these. Two bodies that stand in each other for good are better told to
    the surface, as `ignored`: with exclusion they can hardly be moved against each other, as other triangles would
    meet.

    Args:
        surface: triangles, (F, 3) integers, or a :class:`stiv.Surface`.
        deformation: the map from controls to surface positions.
        controls: (m, 3) controls at the start, world coordinates.
        options: how edits are solved.

    Raises:
        InputError: shapes or values that do not fit; the message names object and element.
        StartIntersectsError: the start intersects itself; ``pairs`` lists the triangles.
    """

    def __init__(
        self,
        surface: Surface | ArrayLike,
        deformation: Deformation,
        controls: ArrayLike,
        options: EditOptions | None = None,
    ) -> None:
        self._topology = as_surface(surface, deformation.vertex_count)
        start = as_doubles(controls, "controls")
        chosen = with_numbers(options or EditOptions(), self._topology, lambda: deformation.surface(start))
        self._session = _native.EditSession(self._topology.native, deformation, start, native_options(chosen))

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
        """Distance that surfaces keep, world units."""
        return self._session.separation

    def least_distance(self, *, within: bool = False) -> LeastDistance | None:
        """Return how near bodies are to each other in the accepted state; ``within``: or a body to itself.

        See :func:`stiv.least_distance`.
        """
        return least_distance_of(self._session.least_distance(within), self._topology)

    def is_step_free(self, start: ArrayLike, end: ArrayLike) -> bool:
        """Tell whether the linear step between two surfaces, (N, 3) each, is free: its whole path and its end.

        `start` must be free. As :meth:`stiv.StepCheck.is_free`, with the trees that edits use; the accepted surface
        itself is not tested again. Not for sessions with excluded pairs.
        """
        return self._session.is_step_free(as_doubles(start, "start"), as_doubles(end, "end"))

    def edit(
        self, goal: ArrayLike, *, cancel: CancelToken | None = None, progress: Progress | None = None
    ) -> EditResult:
        """One edit from the accepted controls toward ``goal``, (m, 3).

        ``cancel.cancel()``, from another thread or from ``progress``, ends it within milliseconds with the state
        before the edit. ``progress(phase, fraction)`` is called between rounds; an exception in it cancels, and is
        raised again.
        """
        return result_of(self._session.edit(as_doubles(goal, "goal"), cancel, progress), self._topology)

    def drag(
        self,
        goal: ArrayLike,
        *,
        cancel: CancelToken | None = None,
        progress: Progress | None = None,
        time_budget: float | None = None,
    ) -> EditResult:
        """One mouse move of a drag toward the absolute ``goal``, (m, 3).

        First the increment since the goal before, then a pull toward what is missing, so that goals deep inside an
        obstacle neither lose travel nor drag sideways, and the shape comes back with the mouse.

        ``time_budget``, seconds, counts for this call instead of that of the options. What it ends with nothing
        accepted is taken up by the next call with the same goal; another goal begins anew, with the whole increment.
        """
        values = self._session.drag(as_doubles(goal, "goal"), cancel, progress, time_budget)
        return result_of(values, self._topology)

    def settle(self, *, cancel: CancelToken | None = None, progress: Progress | None = None) -> EditResult:
        """Solve again toward the last goal until the energy no longer falls; it never grows."""
        return result_of(self._session.settle(cancel, progress), self._topology)

    def restore(self, controls: ArrayLike, goal: ArrayLike | None = None) -> None:
        """Take ``controls``, (m, 3), accepted earlier, as the accepted ones (undo, cancel).

        ``goal``, (m, 3), is taken as the last drag's, from which the increment of the next one counts; None: the
        controls themselves. What edits give from here on does not depend on those before.

        Raises:
            StartIntersectsError: their surface intersects itself; nothing is changed.
        """
        toward = None if goal is None else as_doubles(goal, "goal")
        self._session.restore(as_doubles(controls, "controls"), toward)


def edit(
    surface: Surface | ArrayLike,
    deformation: Deformation,
    controls: ArrayLike,
    goal: ArrayLike,
    options: EditOptions | None = None,
) -> EditResult:
    """The one-off form of :meth:`EditSession.edit`."""
    return EditSession(surface, deformation, controls, options).edit(goal)
