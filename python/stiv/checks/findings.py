# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of a check: pairs of elements that intersect, at a frame or between two, and the tested shapes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

INTERSECTION, CROSSING, SEAM = "intersection", "crossing", "seam"


@dataclass(frozen=True, order=True)
class Element:
    """A triangle of a mesh file, or a face, edge or vertex of an evaluated mesh, with its index in its object."""

    object: str
    kind: str
    number: int

    def __str__(self) -> str:
        """Text for messages."""
        return f'object "{self.object}", {self.kind} {self.number}'


@dataclass(frozen=True)
class Finding:
    """A pair of elements that intersect.

    An "intersection" is at `frame` (None: the file has no frames). A "crossing" is on the linear motion from `frame` to
    `to_frame`, at the fraction `time`, while both poses are clear. A "seam" is not an intersection: two faces of an
    object touch only at coincident vertices.
    """

    first: Element
    second: Element
    kind: str = INTERSECTION
    frame: float | None = None
    to_frame: float | None = None
    time: float | None = None
    triangle_pairs: int = 1  #: number of intersecting pairs of their triangles
    scene: str = ""  #: its name, in a file with several scenes
    rendered: bool = False  #: found in the render alone

    @property
    def objects(self) -> tuple[str, str]:
        """The names of the two objects, in alphabetical order."""
        one, other = sorted((self.first.object, self.second.object))
        return one, other

    def __str__(self) -> str:
        """Text for messages."""
        how = "as rendered: " if self.rendered else ""
        return f"{when(self)}{how}{self.first} - {self.second}"


@dataclass(frozen=True, order=True)
class Untested:
    """An object that was not tested; `reason` is a noun phrase or an adjective: "hidden", "point clouds"."""

    object: str
    reason: str
    scene: str = ""  #: its name, in a file with several scenes


@dataclass(frozen=True)
class SeamPairs:
    """Faces of an object that touch along seams: pairs of their indices, (k, 2). `kind` is that of the elements."""

    object: str
    kind: str
    pairs: NDArray[np.int32]

    def findings(self) -> Iterator[Finding]:
        """Each pair as a finding."""
        for a, b in self.pairs.tolist():
            yield Finding(Element(self.object, self.kind, a), Element(self.object, self.kind, b), SEAM)


def merged_seams(looks: Sequence[SeamPairs]) -> tuple[SeamPairs, ...]:
    """Returns the pairs of each object, each pair once."""
    found: dict[tuple[str, str], list[NDArray[np.int32]]] = {}
    for each in looks:
        found.setdefault((each.object, each.kind), []).append(each.pairs)
    return tuple(
        SeamPairs(*key, pairs[0] if len(pairs) == 1 else np.unique(np.concatenate(pairs), axis=0))
        for key, pairs in found.items()
    )


@dataclass(frozen=True)
class Shapes:
    """The tested triangles in one pose, with the elements that they belong to."""

    positions: NDArray[np.float64]  #: (N, 3) in world space
    triangles: NDArray[np.int32]  #: (F, 3)
    names: tuple[str, ...]  #: names of the objects
    owner: NDArray[np.int32]  #: (F,) object of each triangle
    number: NDArray[np.int32]  #: (F,) index of the face, or of the triangle in a mesh file, within its object


@dataclass(frozen=True)
class Look:
    """Results for one pose (`to_frame` None), or for the motion from one pose to the next."""

    shapes: Shapes
    frame: float | None = None
    to_frame: float | None = None
    findings: tuple[Finding, ...] = ()
    notes: tuple[str, ...] = ()  #: limits of the test
    seams: tuple[SeamPairs, ...] = ()
    untested: tuple[Untested, ...] = ()
    scene: str = ""  #: its name, in a .blend


@dataclass(frozen=True)
class FileCheck:
    """Results for one file. With an `error`, the file could not be checked."""

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
    scenes: tuple[str, ...] = ()  #: names of the tested scenes of a .blend
    untested: tuple[Untested, ...] = ()

    @property
    def triangle_pairs(self) -> int:
        """Number of intersecting pairs of triangles, without those that the baseline accepts."""
        return sum(finding.triangle_pairs for finding in self.findings)

    @property
    def seam_count(self) -> int:
        """Number of pairs of faces that touch along seams."""
        return sum(len(each.pairs) for each in self.seams)

    @property
    def free(self) -> bool:
        """Whether the file was checked and the baseline accepts all findings."""
        return not self.error and not self.findings


def when(finding: Finding) -> str:
    """Scene and frames of a finding as the start of a line; empty if it has none."""
    frames = "" if finding.frame is None else f"frame {finding.frame:g}"
    if finding.frame is not None and finding.to_frame is not None:
        frames = f"between frames {finding.frame:g} and {finding.to_frame:g}"
    text = ", ".join(part for part in (finding.scene and f'scene "{finding.scene}"', frames) if part)
    return f"{text}: " if text else ""


def untested_text(untested: Sequence[Untested], most: int = 3) -> str:
    """Number of untested objects by reason, with the first names: `hidden: 2 ("Proxy", "Ref"); ...`."""
    names: dict[str, dict[str, None]] = {}
    for each in untested:
        names.setdefault(each.reason, {})[each.object] = None
    texts = []
    for reason, objects in sorted(names.items()):
        listed = ", ".join(f'"{name}"' for name in list(objects)[:most]) + (", ..." if len(objects) > most else "")
        texts.append(f"{reason}: {len(objects):,} ({listed})")
    return "; ".join(texts)


def counted(pairs: int, triangle_pairs: int) -> str:
    """Both counts as text; the second only if it differs."""
    noun = "pair" if pairs == 1 else "pairs"
    return f"{pairs:,} intersecting {noun}" + (f", {triangle_pairs:,} of triangles" if triangle_pairs != pairs else "")
