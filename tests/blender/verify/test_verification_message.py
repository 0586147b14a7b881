# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages of a failed test of Blender's evaluation."""

import pytest

from stiv.blender.scene.elements import Element, FacePair
from stiv.blender.verify.verification import _intersection_message


@pytest.mark.parametrize(("other", "said"), [("Cube", "Cube cuts itself"), ("Wall", "Cube cuts Wall")])
def test_an_object_that_intersects_itself_is_named_once(other: str, said: str) -> None:
    pair = FacePair(Element("Cube", "face", 1), Element(other, "face", 2))
    assert _intersection_message((pair,)) == f"{said} in the viewport, 2 faces"
