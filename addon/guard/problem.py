# SPDX-License-Identifier: GPL-3.0-or-later
"""The intersections of a guarded scene and their cause, in the texts of status bar, view and panel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .. import stiv_blender
from ..intersection_texts import details, element_lines, headline
from ..modal.header_texts import Translate


@dataclass(frozen=True)
class Problem:
    """Intersections that the guard leaves alone, or a reason why it could not test the scene.

    Attributes:
        pairs: pairs of intersecting elements.
        reason: why they were not corrected; empty if no correction was tried.
        known: they intersected when the guard was turned on.
    """

    pairs: Sequence[stiv_blender.FacePair] = ()
    reason: str = ""
    known: bool = False

    @property
    def names(self) -> list[str]:
        """Names of the intersecting objects."""
        return sorted({each.object for pair in self.pairs for each in (pair.first, pair.second)})

    def headline(self, translate: Translate = str) -> str:
        """One line for the status bar: the objects and the number of their faces, or the reason."""
        return headline(self.pairs, translate) or self.reason

    def pair_lines(self, translate: Translate = str) -> list[str]:
        """The pairs of objects, then the first pairs of faces, one a line."""
        return [*details(self.pairs, translate), *element_lines(self.pairs, translate)]
