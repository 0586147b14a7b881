# SPDX-License-Identifier: GPL-3.0-or-later
from types import SimpleNamespace

import numpy as np
import pytest

from stiv_addon.overlay.content import Clearance, Content, shapes_of, texts_of

SWITCHES = ("contacts", "goal", "intersections", "clearance", "speed")
ALL, NONE = (SimpleNamespace(**dict.fromkeys(SWITCHES, on)) for on in (True, False))
NO_EDGES = np.empty((0, 2), int)


def full() -> Content:
    return Content(
        contacts=SimpleNamespace(triangles=np.zeros((5, 3, 3)), strengths=np.full((5, 3), 0.5)),
        ghost=SimpleNamespace(points=np.eye(3), triangles=np.array([[0, 1, 2]]), edges=NO_EDGES),
        intersecting=np.zeros((3, 3, 3)),
        clearance=Clearance(np.zeros(3), np.array([0.0, 3.0, 4.0]), 5.0, ("Box", "Wall")),
        milliseconds=12.3,
        frames=40.0,
    )


def test_empty_content_is_false() -> None:
    assert not Content()
    assert shapes_of(Content(), ALL) == {}
    assert texts_of(Content(), ALL, str) == []
    assert full()


def test_switches_hide_shapes_and_texts() -> None:
    assert list(shapes_of(full(), ALL)) == ["ghost", "contacts", "faces", "clearance"]
    assert shapes_of(full(), NONE) == {}
    assert texts_of(full(), NONE, str) == []


def test_each_point_of_the_contacts_has_its_strength() -> None:
    shape = shapes_of(full(), ALL)["contacts"]
    assert shape.kind == "TRIS" and shape.points.shape == (15, 3) and shape.strengths.shape == (15,)


def test_a_large_ghost_is_a_box_of_lines() -> None:
    content = full()
    content.ghost = SimpleNamespace(points=np.zeros((8, 3)), triangles=np.empty((0, 3), int), edges=np.array([[0, 1]]))
    assert shapes_of(content, ALL)["ghost"].kind == "LINES"
    assert shapes_of(full(), ALL)["ghost"].kind == "TRIS"


@pytest.mark.parametrize(("names", "first"), [(("Box", "Wall"), "Box, Wall: clearance 5.0 m"), ((), "12 ms, 40 fps")])
def test_texts_give_a_named_clearance_and_the_speed(names: tuple[str, ...], first: str) -> None:
    content = full()
    content.clearance = Clearance(np.zeros(3), np.ones(3), 5.0, names)
    assert texts_of(content, ALL, lambda length: f"{length} m")[0] == first
