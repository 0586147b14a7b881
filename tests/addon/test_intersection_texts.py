# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersections in words: names first, one count of faces everywhere, within a line."""

import pytest

pytest.importorskip("bpy")
pytest.importorskip("stiv._native")

from stiv.blender import Element, FacePair
from stiv_addon.intersection_texts import LENGTH, as_message, brief, details, element_lines, headline


def pair(first: str, i: int, second: str, j: int, evaluation: str = "shown") -> FacePair:
    return FacePair(Element(first, "face", i, evaluation), Element(second, "face", j, evaluation), 3)


FAN = [pair("Suzanne", 0, "Spot", j) for j in range(5)]  # one face against five


def test_two_objects_are_named_with_the_number_of_their_faces() -> None:
    assert headline(FAN) == "Spot cuts Suzanne, 6 faces"
    assert headline([]) == ""
    assert details(FAN) == []


def test_an_object_may_cut_itself() -> None:
    assert headline([pair("Suzanne", 1, "Suzanne", 2)]) == "Suzanne cuts itself, 2 faces"


def test_a_face_counts_once_and_only_shown_ones_do_unless_none_is() -> None:
    render = [pair("Suzanne", 7, "Spot", 8, "render")]
    assert headline(FAN + render) == "Spot cuts Suzanne, 6 faces"
    assert headline(render) == "Spot cuts Suzanne, 2 faces"


def test_more_pairs_of_objects_have_a_line_each_the_largest_first() -> None:
    pairs = [pair("Cube", 0, "Wall", 0), *FAN, pair("Wall", 1, "Wall", 2)]
    assert headline(pairs) == "Cube, Wall and 2 more intersect, 10 faces"
    assert details(pairs) == ["Spot cuts Suzanne: 6 faces", "Cube cuts Wall: 2 faces", "Wall cuts itself: 2 faces"]


def test_the_first_faces_are_named_and_the_others_counted() -> None:
    lines = element_lines(FAN)
    assert lines[0] == "Suzanne face 0, Spot face 0"
    assert lines[-1] == "and 2 more"


def test_long_names_leave_the_line_short_enough() -> None:
    names = ("The Wall Beside the Stairs of the House", "Another Object With a Name of Sixty Letters and More")
    for text in (headline([pair(names[0], 0, names[1], 0)]), headline([pair(n, 0, n, 1) for n in (*names, "C", "D")])):
        assert len(text) <= LENGTH and text.startswith(("Another", "The"))


def test_the_first_clauses_of_a_long_text_are_reported() -> None:
    assert brief("short; text. Here") == "short; text. Here"
    assert brief("the start intersects: 150 pairs of faces, " + "x" * 90) == "the start intersects: 150 pairs of faces"
    assert brief("Cube: no. " + "y " * 60) == "Cube: no"
    assert len(brief("z" * 200)) == LENGTH


def test_a_message_has_as_many_lines_as_fit() -> None:
    assert as_message(["a", "b" * 30, "c" * 30, "d" * 30]) == "a; " + "b" * 30 + "; " + "c" * 30
    assert as_message(["a" * 90, "b"]) == "a" * 90
