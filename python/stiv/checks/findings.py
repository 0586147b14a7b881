# SPDX-License-Identifier: GPL-3.0-or-later
"""What a check finds: elements that meet, at a frame or between two, and the shapes they were found in."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

INTERSECTION, CROSSING, SEAM = "intersection", "crossing", "seam"


@dataclass(frozen=True, order=True)
class Element:
    """A triangle of a mesh file, or a face, edge or vertex of an evaluated mesh, by its number in its object."""

    object: str
    kind: str
    number: int

    def __str__(self) -> str:
        """As messages name it."""
        return f'object "{self.object}", {self.kind} {self.number}'


@dataclass(frozen=True)
class Finding:
    """Two elements that meet.

    `kind` is "intersection" where they meet in the pose of `frame` (None: of what has no frames), and "crossing" where
    both poses are free there, but the straight way from `frame` to `to_frame` is not: it meets at the fraction `time`.
    A "seam" is no intersection: two faces of an object that touch in coincident vertices alone.
    """

    first: Element
    second: Element
    kind: str = INTERSECTION
    frame: float | None = None
    to_frame: float | None = None
    time: float | None = None
    triangle_pairs: int = 1  #: how many pairs of their triangles meet
    scene: str = ""  #: of a file with several scenes
    rendered: bool = False  #: found in what is rendered, and not in what the viewport shows

    @property
    def objects(self) -> tuple[str, str]:
        """The names of the two objects, in alphabetical order."""
        one, other = sorted((self.first.object, self.second.object))
        return one, other

    def __str__(self) -> str:
        """As messages tell it."""
        how = "as rendered: " if self.rendered else ""
        return f"{when(self)}{how}{self.first} - {self.second}"


@dataclass(frozen=True, order=True)
class LeftOut:
    """An object that is not tested; `why` is a noun phrase or an adjective: "hidden", "point clouds"."""

    object: str
    why: str
    scene: str = ""  #: of a file with several scenes


@dataclass(frozen=True)
class SeamPairs:
    """Faces of an object that touch along seams: pairs of their numbers, (k, 2). `kind` is that of the elements."""

    object: str
    kind: str
    pairs: NDArray[np.int32]

    def findings(self) -> Iterator[Finding]:
        """Each pair as a finding."""
        for a, b in self.pairs.tolist():
            yield Finding(Element(self.object, self.kind, a), Element(self.object, self.kind, b), SEAM)


def merged_seams(looks: Sequence[SeamPairs]) -> tuple[SeamPairs, ...]:
    """Those of each object together, each pair once."""
    found: dict[tuple[str, str], list[NDArray[np.int32]]] = {}
    for each in looks:
        found.setdefault((each.object, each.kind), []).append(each.pairs)
    return tuple(
        SeamPairs(*key, pairs[0] if len(pairs) == 1 else np.unique(np.concatenate(pairs), axis=0))
        for key, pairs in found.items()
    )


@dataclass(frozen=True)
class Shapes:
    """The triangles that were tested, in the pose of a finding, with the elements they belong to."""

    positions: NDArray[np.float64]  #: (N, 3) in world space
    triangles: NDArray[np.int32]  #: (F, 3)
    names: tuple[str, ...]  #: of the objects
    owner: NDArray[np.int32]  #: (F,) object of each triangle
    number: NDArray[np.int32]  #: (F,) number of the face, or of the triangle in a mesh file, within its object


@dataclass(frozen=True)
class Look:
    """What one pose (`to_frame` None), or the way from one to the next, was found to be."""

    shapes: Shapes
    frame: float | None = None
    to_frame: float | None = None
    findings: tuple[Finding, ...] = ()
    notes: tuple[str, ...] = ()  #: what could not be tested
    seams: tuple[SeamPairs, ...] = ()
    left_out: tuple[LeftOut, ...] = ()
    scene: str = ""  #: of a .blend


@dataclass(frozen=True)
class FileCheck:
    """What a file was found to be. With an `error` it could not be checked."""

    file: str
    objects: tuple[str, ...] = ()
    vertices: int = 0
    triangles: int = 0
    frames: tuple[float, ...] = ()
    findings: tuple[Finding, ...] = ()
    accepted: tuple[Finding, ...] = ()  #: findings that the baseline accepts
    notes: tuple[str, ...] = ()
    error: str = ""
    seconds: float = 0.0
    pictures: tuple[str, ...] = field(default=())
    seams: tuple[SeamPairs, ...] = ()
    scenes: tuple[str, ...] = ()  #: of a .blend, that were tested
    left_out: tuple[LeftOut, ...] = ()

    @property
    def triangle_pairs(self) -> int:
        """How many pairs of triangles meet, those that the baseline accepts left out."""
        return sum(finding.triangle_pairs for finding in self.findings)

    @property
    def seam_count(self) -> int:
        """How many pairs of faces touch along seams."""
        return sum(len(each.pairs) for each in self.seams)

    @property
    def free(self) -> bool:
        """Was it checked, and is nothing left but what the baseline accepts?"""
        return not self.error and not self.findings


def when(finding: Finding) -> str:
    """The scene and the frame or frames of a finding as the start of a line; empty for what has none."""
    frames = "" if finding.frame is None else f"frame {finding.frame:g}"
    if finding.frame is not None and finding.to_frame is not None:
        frames = f"between frames {finding.frame:g} and {finding.to_frame:g}"
    told = ", ".join(text for text in (finding.scene and f'scene "{finding.scene}"', frames) if text)
    return f"{told}: " if told else ""


def left_out_text(left_out: Sequence[LeftOut], most: int = 3) -> str:
    """How many objects are not tested and why, with the first names: `hidden: 2 ("Proxy", "Ref"); ...`."""
    names: dict[str, dict[str, None]] = {}
    for each in left_out:
        names.setdefault(each.why, {})[each.object] = None
    told = []
    for why, objects in sorted(names.items()):
        listed = ", ".join(f'"{name}"' for name in list(objects)[:most]) + (", ..." if len(objects) > most else "")
        told.append(f"{why}: {len(objects):,} ({listed})")
    return "; ".join(told)


def counted(pairs: int, triangle_pairs: int) -> str:
    """Both counts for people; the second only where it differs."""
    noun = "pair" if pairs == 1 else "pairs"
    return f"{pairs:,} intersecting {noun}" + (f", {triangle_pairs:,} of triangles" if triangle_pairs != pairs else "")
