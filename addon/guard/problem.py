# SPDX-License-Identifier: GPL-3.0-or-later
"""Why the guard leaves a tool's result as it is, in the words of the status bar, the view and the panel."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

Say = Callable[[str], str]
MOST_PAIRS = 3  # listed one a line
MOST_NAMES = 3


@dataclass(frozen=True)
class Problem:
    """An intersecting scene, or a reason why it could not be tested.

    Attributes:
        pairs: pairs of elements that meet, as `stiv.blender.FacePair`.
        reason: why they were not taken apart; empty where nothing was tried.
    """

    pairs: Sequence[Any] = ()
    reason: str = ""

    @property
    def names(self) -> list[str]:
        """Objects that intersect."""
        return sorted({each.object for pair in self.pairs for each in (pair.first, pair.second)})

    def headline(self, say: Say = str) -> str:
        """One line for the status bar: which objects, how many pairs, and the first of them."""
        if not self.pairs:
            return self.reason
        first = self.pairs[0]
        names, numbers = listed(self.names, say), (first.first.number, first.second.number)
        if len(self.pairs) == 1:
            return say("{}: 1 intersecting face pair, {} and {}").format(names, *numbers)
        return say("{}: {} intersecting face pairs, first {} and {}").format(names, len(self.pairs), *numbers)

    def pair_lines(self, say: Say = str) -> list[str]:
        """The first pairs, one a line, and how many more there are."""
        lines = [f"{_element(pair.first, say)}, {_element(pair.second, say)}" for pair in self.pairs[:MOST_PAIRS]]
        more = len(self.pairs) - len(lines)
        return [*lines, say("and {} more").format(more)] if more > 0 else lines


def listed(names: Iterable[str], say: Say = str) -> str:
    """Some names, and how many more there are."""
    every = list(names)
    shown = ", ".join(every[:MOST_NAMES])
    return say("{} and {} more").format(shown, len(every) - MOST_NAMES) if len(every) > MOST_NAMES else shown


def _element(element: Any, say: Say) -> str:
    kinds = {"face": say("face {}"), "edge": say("edge {}"), "vertex": say("vertex {}")}
    return f"{element.object} {kinds[element.kind].format(element.number)}"
