# SPDX-License-Identifier: GPL-3.0-or-later
"""What intersects in a guarded scene, and why, in the texts of status bar, view and panel."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from .. import stiv_blender
from ..modal.header_texts import Translate

MAX_PAIRS = 3  # listed, one a line
MAX_NAMES = 3


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

    @property
    def object_pairs(self) -> list[tuple[str, str]]:
        """The pairs of intersecting objects."""
        return sorted({stiv_blender.object_pair(pair) for pair in self.pairs})

    def headline(self, translate: Translate = str) -> str:
        """One line for the status bar: the objects, the number of pairs, and the first pair."""
        if not self.pairs:
            return self.reason
        first = self.pairs[0]
        names, numbers = listed(self.names, translate), (first.first.number, first.second.number)
        if len(self.pairs) == 1:
            return translate("{}: 1 intersecting face pair, {} and {}").format(names, *numbers)
        return translate("{}: {} intersecting face pairs, first {} and {}").format(names, len(self.pairs), *numbers)

    def pair_lines(self, translate: Translate = str) -> list[str]:
        """The first pairs, one a line, and the number of the others."""
        lines = [
            f"{_element(pair.first, translate)}, {_element(pair.second, translate)}" for pair in self.pairs[:MAX_PAIRS]
        ]
        others = len(self.pairs) - len(lines)
        return [*lines, translate("and {} more").format(others)] if others > 0 else lines


def listed(names: Iterable[str], translate: Translate = str) -> str:
    """The first names, and the number of the others."""
    every = list(names)
    first, others = ", ".join(every[:MAX_NAMES]), len(every) - MAX_NAMES
    return translate("{} and {} more").format(first, others) if others > 0 else first


def _element(element: stiv_blender.Element, translate: Translate) -> str:
    kinds = {"face": translate("face {}"), "edge": translate("edge {}"), "vertex": translate("vertex {}")}
    return f"{element.object} {kinds[element.kind].format(element.number)}"
