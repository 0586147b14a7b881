# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages about states that Blender shows with intersections."""

import pytest

pytest.importorskip("bpy")

from stiv.blender.scene.elements import Element, FacePair
from stiv.blender.verify.verification import _intersection_message


@pytest.mark.parametrize(
    ("other", "text"),
    [("Head", "Head cuts itself in the viewport, 2 faces"), ("Box", "Head cuts Box in the viewport, 2 faces")],
)
def test_an_object_that_intersects_itself_is_named_once(other: str, text: str) -> None:
    pairs = (FacePair(Element("Head", "face", 3), Element(other, "face", 7)),)
    assert _intersection_message(pairs) == text
