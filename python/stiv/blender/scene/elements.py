# SPDX-License-Identifier: GPL-3.0-or-later
"""Elements of evaluated meshes as messages and reports name them, and pairs of elements that intersect."""

from collections.abc import Iterable
from dataclasses import dataclass, field

from stiv.blender.scene.evaluations import SHOWN

PART = "\t"  # between the name of an object and the number of a part


@dataclass(frozen=True)
class Element:
    """A face, edge or vertex of an object's evaluated mesh, or a strand; `kind` says which.

    evaluation: "shown", or "viewport" (Object Mode) or "render" for elements that are not shown now.
    part: of a mesh that an edit divides.
    """

    object: str
    kind: str
    number: int
    evaluation: str = SHOWN
    part: int = 0

    @property
    def side(self) -> str:
        """Name of the object; extended for all parts of a divided mesh but the first."""
        return f"{self.object}{PART}{self.part}" if self.part else self.object


@dataclass(frozen=True)
class FacePair:
    """Two intersecting elements, the second a face, and the number of their intersecting triangles."""

    first: Element
    second: Element
    triangle_pairs: int = field(default=1, compare=False)


def count_faces(pairs: Iterable[FacePair]) -> int:
    """Number of different faces in the pairs: of those that are shown, if there are any."""
    faces = {each for pair in pairs for each in (pair.first, pair.second) if each.kind == "face"}
    return sum(each.evaluation == SHOWN for each in faces) or len(faces)
