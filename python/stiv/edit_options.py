# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of an edit: each with its name, default, meaning and conversion for the core, declared once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, Field, dataclass, field, fields, replace
from enum import Enum
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stiv import _native
from stiv._native import InputError
from stiv.arrays import Floats, as_choice, as_indices
from stiv.intersections import find_intersections
from stiv.paper_preset import PAPER_OPTIONS
from stiv.surface import Surface

_MOST_SHOWN = 6  # entries of a list that a repr shows


@dataclass(frozen=True)
class StorageFrame:
    """Controls that are stored in single precision in a frame of their own.

    Storing changes the world position ``x`` of controls ``first`` to ``first + count - 1`` to
    ``frame @ float32(inverse(frame) @ x)``.
    """

    first: int
    count: int
    frame: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))  #: (4, 4) affine, local to world


def as_doubles(value: ArrayLike, name: str) -> NDArray[np.float64]:
    """Return `value` as float64. The core checks shape and numbers, because it knows the names of objects."""
    try:
        return np.ascontiguousarray(value, np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"{name}: expected an array of real numbers") from error


def as_weights(value: ArrayLike | None) -> Floats:
    """Return weights, (m,) or (m, 3), as one row of coordinates."""
    weights = np.zeros(0) if value is None else as_doubles(value, "weights")
    if weights.ndim == 1 or (weights.ndim == 2 and weights.shape[1] == 3):
        return weights.ravel()
    raise InputError(f"weights: shape is {weights.shape}, expected (m,) or (m, 3): one for each control or coordinate")


def as_weight_axes(value: ArrayLike | None) -> list[Floats]:
    """Return the axes of each control's weights, (3, 3) each."""
    axes = np.zeros((0, 3, 3)) if value is None else as_doubles(value, "weight_axes")
    if axes.ndim == 3 and axes.shape[1:] == (3, 3):
        return list(axes)
    raise InputError(f"weight_axes: shape is {axes.shape}, expected (m, 3, 3)")


def _storage(frames: Sequence[StorageFrame]) -> list[_native.StorageFrame]:
    return [_native.StorageFrame(each.first, each.count, as_doubles(each.frame, "frame")) for each in frames]


def _pair_separations(distances: Mapping[tuple[int, int], float]) -> list[_native.BodyPairSeparation]:
    return [_native.BodyPairSeparation(int(a), int(b), float(h)) for (a, b), h in distances.items()]


def _excluded_pairs(pairs: ArrayLike | None) -> list[list[int]]:
    rows: list[list[int]] = [] if pairs is None else as_indices(pairs, "exclude", (None, 2)).tolist()
    return rows


def _body_pairs(pairs: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    return [(int(a), int(b)) for a, b in pairs]


def _bodies(bodies: Sequence[int]) -> list[int]:
    return [int(body) for body in bodies]


def _choice(default: str, name: str, choices: type[Enum]) -> Any:
    """Return a field whose value names a member of an enum of the core."""
    return field(default=default, metadata={"convert": partial(as_choice, name=name, choices=choices)})


@dataclass(frozen=True)
class SharedOptions:
    """The options that `stiv.EditOptions` and `stiv.blender.EditSettings` have in common."""

    #: minimum distance between surfaces, world units; 0: 1e-4 of the diagonal of the movable surface
    separation: float = 0.0
    smoothness: float = 0.1  #: damping of the response, above 0: 0.1 spreads it smoothly, 0.01 follows the goal closer
    #: edits and settling end at the lowest energy within reach, to 1e-4, instead of a smooth state; about twice as slow
    tight: bool = False
    #: "per_patch" or "single": one constraint for each patch, or one for all
    constraints: str = _choice("per_patch", "constraints", _native.ConstraintKind)
    time_budget: float = 0.0  #: seconds for an edit, which takes one round at least; 0: no limit
    threads: int = 0  #: 0: one for each processor

    def shared(self) -> dict[str, Any]:
        """Return the options of this class by their names."""
        return {option.name: getattr(self, option.name) for option in fields(SharedOptions)}


@dataclass(frozen=True, repr=False)
class EditOptions(SharedOptions):
    """How an edit is solved. The defaults are recommended."""

    #: minimum distance of two bodies, or of a body from itself, instead of `separation`, by name or number:
    #: {("vase", "plant"): 0.01}
    pair_separations: Mapping[tuple[str | int, str | int], float] = field(
        default_factory=dict, metadata={"convert": _pair_separations}
    )
    #: in (0, 1): a pair of primitives nearer than the separation at the start of the session keeps this fraction of its
    #: distance, within a body. This bounds the compression of a mesh finer than the separation
    min_clearance_ratio: float = 0.5
    min_clearance_ratio_between: float = 0.9  #: the same between two bodies
    #: response of each control, (m,), or of each of its coordinates, (m, 3); 0 pins exactly; None: all 1
    weights: ArrayLike | None = field(default=None, metadata={"convert": as_weights})
    #: (m, 3, 3): the three weights of a control act along the columns of a rotation; None: x, y and z
    weight_axes: ArrayLike | None = field(default=None, metadata={"convert": as_weight_axes})
    #: (k, 2) pairs of triangles that may intersect, or "intersecting": all that do at the start; see EditSession
    exclude: ArrayLike | str | None = field(default=None, metadata={"convert": _excluded_pairs})
    #: whether excluded pairs of parts of a body that only touch at the start may intersect to any depth, such as those
    #: along open seams; otherwise no deeper than rounding
    parts_may_cut: bool = False
    #: pairs of bodies, by name or number, that may overlap, but no more than at the start. They can part in any
    #: direction, and are guarded once they are apart. "intersecting": all pairs of bodies that do at the start
    overlapping: Sequence[tuple[str | int, str | int]] | str = field(default=(), metadata={"convert": _body_pairs})
    #: bodies, by name or number: two of them that only touch at the start may slide, part and touch, but never
    #: intersect deeper than rounding. One of the two must be closed
    touching: Sequence[str | int] = field(default=(), metadata={"convert": _bodies})
    #: "lcp": contacts only push; "linear": they also pull, and each round starts without constraints
    solver: str = _choice("lcp", "solver", _native.ConstraintSolver)
    #: norm that a step minimizes: "energy", of the motion of the surface; "controls", of the controls [Algorithm 1]
    metric: str = _choice("energy", "metric", _native.MetricKind)
    #: "relative": by the approach of two sides; "published": by each side's own motion, with Appendix A's gradient;
    #: "published_frozen": the same with constant time, normal and weights of a contact
    volumes: str = _choice("relative", "volumes", _native.VolumeKind)
    #: of the rounds: "conservative", or "polynomial" as published; acceptance is always conservative and exact
    narrow_phase: str = _choice("conservative", "narrow_phase", _native.NarrowPhase)
    broad_phase: str = _choice("bvh", "broad_phase", _native.BroadPhase)  #: "hash_grid", "brute_force": for comparison
    #: passes of rounds and acceptance toward a goal or sub-goal; an edit refines its solution in at most twice as many.
    #: 1: one pass in all, without sub-goals
    max_sub_edits: int = 6
    max_rounds: int = 60  #: detections and responses in a sub-edit
    accumulated_rounds: int = 12  #: rounds that keep the constraints of earlier rounds
    pull_limit: float = 0.04  #: maximum pull of a drag toward its goal, in diagonals of the movable surface; 0: none
    single_precision: bool = True  #: whether controls are stored as float32
    #: frames of stored controls; empty: world coordinates for all
    storage: Sequence[StorageFrame] = field(default=(), metadata={"convert": _storage})

    def __repr__(self) -> str:
        """Return the options that differ from their defaults; arrays by their shape."""
        chosen = ((option.name, getattr(self, option.name), option) for option in fields(self))
        return f"EditOptions({', '.join(_shown(name, value) for name, value, each in chosen if _differs(value, each))})"

    @classmethod
    def paper(cls, **others: Any) -> EditOptions:
        """Return the method as published (Harmon et al. 2011), the baseline of the benchmarks.

        `stiv.PAPER_DIFFERENCES` lists how the defaults differ from it and why. Accepted states pass the same exact
        test. Separation 0 aims for no distance. constraints="single" and solver="linear" are its variants [3.3].
        """
        return cls(**{**PAPER_OPTIONS, **others})

    @classmethod
    def paper_frozen(cls, **others: Any) -> EditOptions:
        """Return `paper` with constant time, normal and weights of a contact in the gradient, for comparison.

        This was `paper` in version 0.1.0. It overshoots, and ends further from the goal than `paper`.
        """
        return cls.paper(**{"volumes": "published_frozen", **others})


def _differs(value: Any, option: Field[Any]) -> bool:
    """Return whether a value differs from the default of its option."""
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
    """Return a description by the shape, or by the type if there is none."""
    if isinstance(value, np.ndarray):
        return f"array of shape {value.shape}"
    try:
        return f"{type(value).__name__} of shape {np.shape(value)}"
    except ValueError:
        return f"{type(value).__name__} of {len(value)}, rows differ in length"


def native_options(options: EditOptions) -> _native.EditOptions:
    """Return the options in the form of the core."""
    native = _native.EditOptions()
    for option in fields(options):
        value = getattr(options, option.name)
        convert = option.metadata.get("convert", lambda given: given)
        try:
            setattr(native, option.name, convert(value))
        except TypeError as error:
            raise InputError(f"{_shown(option.name, value).replace('=', ': ', 1)} is of the wrong type") from error
    return native


def _excluded(pairs: ArrayLike | str | None, surface: Surface, start: Callable[[], Floats]) -> ArrayLike | None:
    """Return the given pairs of triangles; for "intersecting", those that intersect at the start."""
    if not isinstance(pairs, str):
        return pairs
    if pairs != "intersecting":
        raise InputError(f"exclude: {pairs!r} is neither 'intersecting' nor pairs of triangles")
    return find_intersections(start(), surface)


def _overlapping(
    pairs: Sequence[tuple[str | int, str | int]] | str, surface: Surface, start: Callable[[], Floats]
) -> list[tuple[str | int, str | int]]:
    """Return pairs of numbers of bodies; for "intersecting", those that intersect at the start."""
    if not isinstance(pairs, str):
        names = [body.name for body in surface.bodies]
        return [(_body_number(a, names), _body_number(b, names)) for a, b in pairs]
    if pairs != "intersecting":
        raise InputError(f"overlapping: {pairs!r} is neither 'intersecting' nor pairs of bodies")
    bodies = surface.vertex_body[surface.triangles[find_intersections(start(), surface), 0]]
    return [(a, b) for a, b in np.unique(np.sort(bodies, axis=1), axis=0).tolist() if a != b]


def _body_number(body: str | int, names: Sequence[str]) -> int:
    """Return the number of a body given by name or number."""
    if not isinstance(body, str):
        return body
    numbers = [number for number, name in enumerate(names) if name == body]
    if len(numbers) != 1:
        raise InputError(f"{len(numbers)} bodies have the name {body!r}; use the number of the body")
    return numbers[0]


def with_numbers(
    options: EditOptions, surface: Surface, start: Callable[[], Floats], obstacles: Sequence[str] = ()
) -> EditOptions:
    """Return the options with numbers for names. `start` returns the positions of the surface at the start.

    obstacles: names of the bodies after those of the surface.
    """
    own = [body.name for body in surface.bodies]
    names = [*own, *obstacles]
    separations: dict[tuple[str | int, str | int], float] = {
        (_body_number(a, names), _body_number(b, names)): h for (a, b), h in options.pair_separations.items()
    }
    return replace(
        options,
        pair_separations=separations,
        exclude=_excluded(options.exclude, surface, start),
        overlapping=_overlapping(options.overlapping, surface, start),
        touching=[_body_number(body, own) for body in options.touching],
    )
