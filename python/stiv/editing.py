# SPDX-License-Identifier: GPL-3.0-or-later
"""Editing sessions: drag what deforms a surface, and get the nearest state that goes through nothing."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv import _native
from stiv._native import CancelToken, Deformation, InputError
from stiv.arrays import Floats, as_indices
from stiv.detection import BROAD_PHASES, NARROW_PHASES, Events
from stiv.distances import LeastDistance, least_distance_of
from stiv.intersections import find_intersections
from stiv.published_method import PAPER_OPTIONS
from stiv.surface import Surface, as_surface

__all__ = ["CancelToken", "EditOptions", "EditResult", "EditSession", "StorageFrame", "edit"]

Progress = Callable[[str, float], None]

CONSTRAINTS: Mapping[str, _native.ConstraintKind] = {
    "per_patch": _native.ConstraintKind.per_patch,
    "single": _native.ConstraintKind.single,
}
SOLVERS: Mapping[str, _native.ConstraintSolver] = {
    "lcp": _native.ConstraintSolver.lcp,
    "linear": _native.ConstraintSolver.linear,
}
METRICS: Mapping[str, _native.MetricKind] = {
    "energy": _native.MetricKind.energy,
    "controls": _native.MetricKind.controls,
}
VOLUMES: Mapping[str, _native.VolumeKind] = {
    "relative": _native.VolumeKind.relative,
    "published": _native.VolumeKind.published,
}
CHOICES: Mapping[str, Mapping[str, Any]] = {
    "constraints": CONSTRAINTS,
    "solver": SOLVERS,
    "metric": METRICS,
    "volumes": VOLUMES,
    "narrow_phase": NARROW_PHASES,
    "broad_phase": BROAD_PHASES,
}


@dataclass(frozen=True)
class StorageFrame:
    """Controls that are stored in single precision in a frame of their own.

    Controls ``first`` to ``first + count - 1`` at world position ``x`` come back from storing as
    ``frame @ float32(inverse(frame) @ x)``.
    """

    first: int
    count: int
    frame: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))  #: (4, 4) affine, local to world


@dataclass(frozen=True)
class EditOptions:
    """How an edit is solved. Every default is the one recommended."""

    separation: float = 0.0  #: distance that surfaces keep, world units; 0: 1e-4 of the diagonal of what may move
    #: distance that two bodies keep, or a body from itself, instead of that: {("vase", "plant"): 0.01}; also by number
    pair_separations: Mapping[tuple[str | int, str | int], float] = field(default_factory=dict)
    keep: float = 0.5  #: in (0, 1): fraction of its distance that a pair keeps in a step which starts nearer than that
    smoothness: float = 0.1  #: damping of the response: 0.1 smooth, 0.01 tight
    weights: ArrayLike | None = None  #: (m,) response of each control, 0 pins it; None: all 1
    #: (k, 2) pairs of triangles that may intersect, or "intersecting": all that do at the start; see EditSession
    exclude: ArrayLike | str | None = None
    constraints: str = "per_patch"  #: "per_patch" or "single": one constraint for each patch, or one for all
    solver: str = "lcp"  #: "lcp", contacts push; "linear", they may also pull, and none is kept from round to round
    metric: str = "energy"  #: "energy", steps that move the surface least; "controls", the controls [Algorithm 1]
    volumes: str = "relative"  #: "relative", of the approach of two sides; "published", of each side's own motion
    #: of the rounds: "conservative", or "polynomial" as published; acceptance is always conservative and exact
    narrow_phase: str = "conservative"
    broad_phase: str = "bvh"  #: "bvh"; "hash_grid" or "brute_force" for comparison
    max_sub_edits: int = 6  #: passes of rounds and acceptance
    max_rounds: int = 60  #: detections and responses in a sub-edit
    accumulated_rounds: int = 12  #: rounds that keep the constraints of the rounds before
    pull_limit: float = 0.04  #: farthest pull of a drag toward its goal, in diagonals of what may move; 0: none
    single_precision: bool = True  #: controls are stored as float32; False: as they are
    storage: Sequence[StorageFrame] = ()  #: frames of stored controls; empty: world coordinates for all
    time_budget: float = 0.0  #: seconds an edit may take; 0: no limit
    threads: int = 0  #: 0: one for each processor

    @classmethod
    def paper(cls, **others: Any) -> EditOptions:
        """Return the method as published (Harmon et al. 2011), the baseline of the benchmarks.

        `stiv.PAPER_DIFFERENCES` says what the defaults do otherwise and why. Accepted states pass the same exact test.
        Without a separation none is aimed for. constraints="single" and solver="linear" are its variants [3.3].
        """
        return cls(**{**PAPER_OPTIONS, **others})


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


def _native_value(name: str, value: Any) -> Any:
    """Turn the value of an option into what the core takes."""
    if name == "weights":
        return np.zeros(0) if value is None else _as_doubles(value, "weights")
    if name == "storage":
        return [_native.StorageFrame(s.first, s.count, _as_doubles(s.frame, "frame")) for s in value]
    if name == "pair_separations":
        return [_native.BodyPairSeparation(int(a), int(b), float(h)) for (a, b), h in value.items()]
    if name == "exclude":
        return [] if value is None else as_indices(value, "exclude", (None, 2)).tolist()
    if name not in CHOICES:
        return value
    choices = CHOICES[name]
    if value not in choices:
        raise InputError(f"{name}: there is no {value!r}, only " + ", ".join(map(repr, choices)))
    return choices[value]


def native_options(options: EditOptions) -> _native.EditOptions:
    """Return the options as the core takes them."""
    native = _native.EditOptions()
    for option in fields(options):
        value = _native_value(option.name, getattr(options, option.name))
        try:
            setattr(native, option.name, value)
        except TypeError as error:
            raise InputError(f"{option.name}: {getattr(options, option.name)!r} is of the wrong type") from error
    return native


def _as_doubles(value: ArrayLike, name: str) -> NDArray[np.float64]:
    """Return `value` as float64; whether it is finite and fits is the core's affair, which knows the objects' names."""
    try:
        return np.ascontiguousarray(value, np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name}: expected an array of real numbers") from error


def _excluded(pairs: ArrayLike | str | None, surface: Surface, start: Callable[[], Floats]) -> ArrayLike | None:
    """Return the pairs of triangles that a word stands for, or those given."""
    if not isinstance(pairs, str):
        return pairs
    if pairs != "intersecting":
        raise InputError(f"exclude: there is no {pairs!r}, only 'intersecting', or pairs of triangles")
    return find_intersections(start(), surface)


def _body_number(body: str | int, surface: Surface) -> int:
    """Return the number of a body given by name or number."""
    if not isinstance(body, str):
        return body
    numbers = [number for number, known in enumerate(surface.bodies) if known.name == body]
    if len(numbers) != 1:
        raise InputError(f"pair_separations: {len(numbers)} bodies have the name {body!r}; use their numbers")
    return numbers[0]


def _with_numbers(options: EditOptions, surface: Surface, start: Callable[[], Floats]) -> EditOptions:
    """Return the options with numbers for the names in them; `start` gives the surface's positions at the start."""
    separations: dict[tuple[str | int, str | int], float] = {
        (_body_number(a, surface), _body_number(b, surface)): h for (a, b), h in options.pair_separations.items()
    }
    return replace(options, pair_separations=separations, exclude=_excluded(options.exclude, surface, start))


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
    ever intersects. It says nothing of how deep an excluded pair goes; but the neighbours of its triangles are
    guarded, so that it cannot go on through them. Two bodies that stand in each other for good are better told to the
    surface, as `ignored`: with exclusion they can hardly be moved against each other, as other triangles would meet.

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
        start = _as_doubles(controls, "controls")
        chosen = _with_numbers(options or EditOptions(), self._topology, lambda: deformation.surface(start))
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

    def edit(
        self, goal: ArrayLike, *, cancel: CancelToken | None = None, progress: Progress | None = None
    ) -> EditResult:
        """One edit from the accepted controls toward ``goal``, (m, 3).

        ``cancel.cancel()``, from another thread or from ``progress``, ends it within milliseconds with the state
        before the edit. ``progress(phase, fraction)`` is called between rounds; an exception in it cancels, and is
        raised again.
        """
        return result_of(self._session.edit(_as_doubles(goal, "goal"), cancel, progress), self._topology)

    def drag(
        self, goal: ArrayLike, *, cancel: CancelToken | None = None, progress: Progress | None = None
    ) -> EditResult:
        """One mouse move of a drag toward the absolute ``goal``, (m, 3).

        First the increment since the goal before, then a pull toward what is missing, so that goals deep inside an
        obstacle neither lose travel nor drag sideways, and the shape comes back with the mouse.
        """
        return result_of(self._session.drag(_as_doubles(goal, "goal"), cancel, progress), self._topology)

    def settle(self, *, cancel: CancelToken | None = None, progress: Progress | None = None) -> EditResult:
        """Solve again toward the last goal until the energy no longer falls; it never grows."""
        return result_of(self._session.settle(cancel, progress), self._topology)

    def restore(self, controls: ArrayLike, goal: ArrayLike | None = None) -> None:
        """Take ``controls``, (m, 3), accepted earlier, as the accepted ones (undo, cancel).

        ``goal``, (m, 3), is taken as the last drag's, from which the increment of the next one counts; None: the
        controls themselves.

        Raises:
            StartIntersectsError: their surface intersects itself; nothing is changed.
        """
        toward = None if goal is None else _as_doubles(goal, "goal")
        self._session.restore(_as_doubles(controls, "controls"), toward)


def edit(
    surface: Surface | ArrayLike,
    deformation: Deformation,
    controls: ArrayLike,
    goal: ArrayLike,
    options: EditOptions | None = None,
) -> EditResult:
    """The one-off form of :meth:`EditSession.edit`."""
    return EditSession(surface, deformation, controls, options).edit(goal)
