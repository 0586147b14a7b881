# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersections in words: a line that names the objects and counts the faces, and details for the panel."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from . import stiv_blender
from .modal.header_texts import Translate, listed

LENGTH = 80  # characters of a message in the status bar
NAME_LENGTH = 20  # characters of a name in a line
LISTED = 5  # pairs of objects
ELEMENTS = 3  # pairs of faces

Pairs = Sequence["stiv_blender.FacePair"]


def headline(pairs: Pairs, translate: Translate = str) -> str:
    """One line: "Suzanne cuts Spot, 629 faces"; "" without pairs."""
    if not pairs:
        return ""
    among = stiv_blender.FacePairs.of(pairs).by_objects()
    if len(among) == 1:
        return f"{_cuts(*next(iter(among)), translate)}, {faces_text(pairs, translate)}"
    names = [short_name(name) for name in dict.fromkeys(name for both in among for name in both)]
    return translate("{} intersect, {}").format(listed(names, translate, 2), faces_text(pairs, translate))


def details(pairs: Pairs, translate: Translate = str) -> list[str]:
    """A line for each of the first pairs of objects, the most faces first; none if the headline says it all."""
    among = stiv_blender.FacePairs.of(pairs).by_objects()
    if len(among) <= 1:
        return []
    counts = {names: stiv_blender.count_faces(own) for names, own in among.items()}
    most = sorted(counts, key=lambda names: -counts[names])[:LISTED]
    lines = [f"{_cuts(*names, translate)}: {counted_faces(counts[names], translate)}" for names in most]
    return _with_others(lines, len(among), translate)


def element_lines(pairs: Pairs, translate: Translate = str) -> list[str]:
    """The first pairs of faces, one a line, and the number of the others."""
    lines = [f"{_element(pair.first, translate)}, {_element(pair.second, translate)}" for pair in pairs[:ELEMENTS]]
    return _with_others(lines, len(pairs), translate)


def faces_text(pairs: Pairs, translate: Translate = str) -> str:
    """The number of different faces in the pairs: the one count of intersections that the interface shows."""
    return counted_faces(stiv_blender.count_faces(pairs), translate)


def counted_faces(count: int, translate: Translate = str) -> str:
    """A number of faces."""
    return translate("1 face" if count == 1 else "{} faces").format(f"{count:,}")


def short_name(name: str) -> str:
    """A name that leaves room for the rest of a line."""
    return name if len(name) <= NAME_LENGTH else name[: NAME_LENGTH - 1] + "…"


def as_message(lines: Iterable[str]) -> str:
    """As many lines as fit the status bar together; the panel shows them all."""
    first, *others = lines
    for line in others:
        if len(first) + len(line) + 2 > LENGTH:
            break
        first += f"; {line}"
    return first


def as_messages(lines: Iterable[str]) -> list[str]:
    """The lines as messages, each with as many of them as fit the status bar together."""
    messages: list[str] = []
    for line in lines:
        if messages and len(messages[-1]) + len(line) + 2 <= LENGTH:
            messages[-1] += f"; {line}"
        else:
            messages.append(line)
    return messages


def brief(text: str) -> str:
    """The first clauses of a text that fit the status bar."""
    if len(text) <= LENGTH:
        return text
    start = text[:LENGTH]
    ends = [start.rfind(mark) for mark in (". ", "; ", ", ", " ")]
    return start[: next((end for end in ends if end > 0), LENGTH)]


def _cuts(first: str, second: str, translate: Translate) -> str:
    if first == second:
        return translate("{} cuts itself").format(short_name(first))
    return translate("{} cuts {}").format(short_name(first), short_name(second))


def _element(element: stiv_blender.Element, translate: Translate) -> str:
    kinds = {
        "face": translate("face {}"), "edge": translate("edge {}"), "vertex": translate("vertex {}"),
        "strand": translate("strand {}"),
    }  # fmt: skip
    return f"{short_name(element.object)} {kinds[element.kind].format(element.number)}"


def _with_others(lines: list[str], count: int, translate: Translate) -> list[str]:
    others = count - len(lines)
    return [*lines, translate("and {} more").format(f"{others:,}")] if others > 0 else lines
