# SPDX-License-Identifier: GPL-3.0-or-later
"""A session is a sequence of stages, each with a surface, a deformation and edits."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

import stiv

from ..shape import Shape, joined

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Edit = Callable[[Array], Array]  #: from the accepted controls (m, 3) to the goal of one edit (m, 3)


@dataclass(frozen=True)
class Stage:
    """A part of a session with a single deformation."""

    name: str
    surface: stiv.Surface
    deformation: stiv.Deformation
    controls: Array  #: (m, 3) at the start
    edits: tuple[Edit, ...]
    options: Mapping[str, object] = field(default_factory=dict)  #: of stiv.EditOptions, unless default


Stages = Generator[Stage, Array, None]  #: generator of stages; receives the controls (m, 3) at the end of each


@dataclass(frozen=True)
class Session:
    """A session of the paper."""

    name: str
    figure: int  #: of the paper
    summary: str
    stages: Callable[[], Stages]


def single(make: Callable[[], Stage]) -> Callable[[], Stages]:
    """The stages of a session with one stage."""

    def stages() -> Stages:
        yield make()

    return stages


def surface_of(shapes: Mapping[str, Shape], mobility: Mapping[str, str] | None = None) -> tuple[stiv.Surface, Array]:
    """Concatenated shapes, each a named body, and their positions; deformable unless `mobility` says otherwise."""
    whole = joined(list(shapes.values()))
    kinds = mobility or {}
    bodies = [stiv.Body(name, kinds.get(name, "deformable")) for name in shapes]
    owner = np.repeat(np.arange(len(shapes)), [len(shape.vertices) for shape in shapes.values()])
    return stiv.Surface(whole.triangles(), len(whole.vertices), vertex_body=owner, bodies=bodies), whole.vertices


def moved(offset: ArrayLike, which: Indices | None = None) -> Edit:
    """Controls (default: all) translated."""
    return _changed(lambda points: points + np.asarray(offset, float), which)


def scaled(factors: ArrayLike, which: Indices | None = None, centre: ArrayLike | None = None) -> Edit:
    """Controls (default: all) scaled about `centre` (default: their mean)."""

    def change(points: Array) -> Array:
        middle = points.mean(axis=0) if centre is None else np.asarray(centre, float)
        result: Array = middle + (points - middle) * np.asarray(factors, float)
        return result

    return _changed(change, which)


def _changed(change: Edit, which: Indices | None) -> Edit:
    def goal(controls: Array) -> Array:
        chosen = np.arange(len(controls)) if which is None else which
        result = controls.copy()
        result[chosen] = change(controls[chosen])
        return result

    return goal


def repeated(edit: Edit, count: int) -> tuple[Edit, ...]:
    """The same edit `count` times."""
    return (edit,) * count
