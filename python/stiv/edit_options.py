# SPDX-License-Identifier: GPL-3.0-or-later
"""How an edit is solved: every choice, its default, and what the core takes for it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, Field, dataclass, field, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv import _native
from stiv._native import InputError
from stiv.arrays import Floats, as_indices
from stiv.detection import BROAD_PHASES, NARROW_PHASES
from stiv.intersections import find_intersections
from stiv.paper_preset import PAPER_OPTIONS
from stiv.surface import Surface

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
    "published_frozen": _native.VolumeKind.published_frozen,
}
CHOICES: Mapping[str, Mapping[str, Any]] = {
    "constraints": CONSTRAINTS,
    "solver": SOLVERS,
    "metric": METRICS,
    "volumes": VOLUMES,
    "narrow_phase": NARROW_PHASES,
    "broad_phase": BROAD_PHASES,
}


_MOST_SHOWN = 6  # entries of a list that a repr shows


@dataclass(frozen=True)
class StorageFrame:
    """Controls that are stored in single precision in a frame of their own.

    Controls ``first`` to ``first + count - 1`` at world position ``x`` come back from storing as
    ``frame @ float32(inverse(frame) @ x)``.
    """

    first: int
    count: int
    frame: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))  #: (4, 4) affine, local to world


@dataclass(frozen=True, repr=False)
class EditOptions:
    """How an edit is solved. Every default is the one recommended."""

    separation: float = 0.0  #: distance that surfaces keep, world units; 0: 1e-4 of the diagonal of what may move
    #: distance that two bodies keep, or a body from itself, instead of that: {("vase", "plant"): 0.01}; also by number
    pair_separations: Mapping[tuple[str | int, str | int], float] = field(default_factory=dict)
    #: in (0, 1): fraction of its distance that a pair of primitives keeps which begins the session nearer than that,
    #: within a body (all that compression leaves of a mesh finer than the separation) ...
    keep: float = 0.5
    keep_between: float = 0.9  #: ... and between two bodies
    smoothness: float = 0.1  #: damping of the response: 0.1 smooth, 0.01 tight
    #: response of each control, (m,), or of each of its coordinates, (m, 3); 0 pins exactly; None: all 1
    weights: ArrayLike | None = None
    #: (m, 3, 3): the three weights of a control act along the columns of a rotation; None: x, y and z
    weight_axes: ArrayLike | None = None
    #: (k, 2) pairs of triangles that may intersect, or "intersecting": all that do at the start; see EditSession
    exclude: ArrayLike | str | None = None
    constraints: str = "per_patch"  #: "per_patch" or "single": one constraint for each patch, or one for all
    solver: str = "lcp"  #: "lcp", contacts push; "linear", they may also pull, and none is kept from round to round
    metric: str = "energy"  #: "energy", steps that move the surface least; "controls", the controls [Algorithm 1]
    #: "relative", of the approach of two sides; "published", of each side's own motion, with Appendix A's gradient;
    #: "published_frozen", the same with the contact's time, normal and weights held
    volumes: str = "relative"
    #: of the rounds: "conservative", or "polynomial" as published; acceptance is always conservative and exact
    narrow_phase: str = "conservative"
    broad_phase: str = "bvh"  #: "bvh"; "hash_grid" or "brute_force" for comparison
    max_sub_edits: int = 6  #: passes of rounds and acceptance
    max_rounds: int = 60  #: detections and responses in a sub-edit
    accumulated_rounds: int = 12  #: rounds that keep the constraints of the rounds before
    pull_limit: float = 0.04  #: farthest pull of a drag toward its goal, in diagonals of what may move; 0: none
    single_precision: bool = True  #: controls are stored as float32; False: as they are
    storage: Sequence[StorageFrame] = ()  #: frames of stored controls; empty: world coordinates for all
    time_budget: float = 0.0  #: seconds an edit may take; never less than one round does; 0: no limit
    threads: int = 0  #: 0: one for each processor

    def __repr__(self) -> str:
        """Name the options that differ from their defaults; arrays by their shape."""
        chosen = ((option.name, getattr(self, option.name), option) for option in fields(self))
        return f"EditOptions({', '.join(_shown(name, value) for name, value, each in chosen if _differs(value, each))})"

    @classmethod
    def paper(cls, **others: Any) -> EditOptions:
        """Return the method as published (Harmon et al. 2011), the baseline of the benchmarks.

        `stiv.PAPER_DIFFERENCES` says what the defaults do otherwise and why. Accepted states pass the same exact test.
        Without a separation none is aimed for. constraints="single" and solver="linear" are its variants [3.3].
        """
        return cls(**{**PAPER_OPTIONS, **others})

    @classmethod
    def paper_frozen(cls, **others: Any) -> EditOptions:
        """Return `paper` with the time, the normal and the weights of a contact held in the gradient: for comparison.

        This was `paper` in version 0.1.0. It overshoots, and stays farther from the goal than `paper`.
        """
        return cls.paper(**{"volumes": "published_frozen", **others})


def _differs(value: Any, option: Field[Any]) -> bool:
    """Return whether a value is not the default of its option."""
    default = option.default_factory() if option.default_factory is not MISSING else option.default
    if value is None or default is None or isinstance(value, np.ndarray):
        return value is not default
    return bool(value != default)


def _shown(name: str, value: Any) -> str:
    """Return "name=value", an array or a long list by its shape."""
    if isinstance(value, np.ndarray) or (isinstance(value, list | tuple) and len(value) > _MOST_SHOWN):
        return f"{name}=<{_shape(value)}>"
    return f"{name}={value!r}"


def _shape(value: Any) -> str:
    """Return a short description of an array by its shape; of anything else its type."""
    if isinstance(value, np.ndarray):
        return f"array of shape {value.shape}"
    try:
        return f"{type(value).__name__} of shape {np.shape(value)}"
    except ValueError:
        return f"{type(value).__name__} of {len(value)}, rows differ in length"


def _weights(value: ArrayLike) -> Floats:
    """Return weights, (m,) or (m, 3), one coordinate after the other."""
    weights = as_doubles(value, "weights")
    if weights.ndim == 1 or (weights.ndim == 2 and weights.shape[1] == 3):
        return weights.ravel()
    raise InputError(f"weights: shape is {weights.shape}, expected (m,) or (m, 3): one for each control or coordinate")


def _weight_axes(value: ArrayLike) -> list[Floats]:
    """Return the axes of each control's weights, (3, 3) each."""
    axes = as_doubles(value, "weight_axes")
    if axes.ndim == 3 and axes.shape[1:] == (3, 3):
        return list(axes)
    raise InputError(f"weight_axes: shape is {axes.shape}, expected (m, 3, 3)")


def _native_value(name: str, value: Any) -> Any:
    """Turn the value of an option into what the core takes."""
    if name == "weights":
        return np.zeros(0) if value is None else _weights(value)
    if name == "weight_axes":
        return [] if value is None else _weight_axes(value)
    if name == "storage":
        return [_native.StorageFrame(s.first, s.count, as_doubles(s.frame, "frame")) for s in value]
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
            shown = _shown(option.name, getattr(options, option.name)).replace("=", ": ", 1)
            raise InputError(f"{shown} is of the wrong type") from error
    return native


def as_doubles(value: ArrayLike, name: str) -> NDArray[np.float64]:
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


def with_numbers(options: EditOptions, surface: Surface, start: Callable[[], Floats]) -> EditOptions:
    """Return the options with numbers for the names in them; `start` gives the surface's positions at the start."""
    separations: dict[tuple[str | int, str | int], float] = {
        (_body_number(a, surface), _body_number(b, surface)): h for (a, b), h in options.pair_separations.items()
    }
    return replace(options, pair_separations=separations, exclude=_excluded(options.exclude, surface, start))
