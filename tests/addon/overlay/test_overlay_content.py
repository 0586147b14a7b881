# SPDX-License-Identifier: GPL-3.0-or-later
from types import SimpleNamespace

import numpy as np
import pytest

from stiv_addon.overlay.content import Clearance, Content, arrows, crosses, lines_of, texts_of

ALL = SimpleNamespace(contacts=True, intersections=True, clearance=True, speed=True)
NONE = SimpleNamespace(contacts=False, intersections=False, clearance=False, speed=False)


def full() -> Content:
    content = Content()
    content.contacts = (np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]), np.array([[1.0, 0, 0], [0, 0.6, 0.8]]))
    content.intersecting = np.zeros((3, 3, 3))
    content.clearance = Clearance(np.zeros(3), np.array([0.0, 3.0, 4.0]), 5.0, ("Box", "Wall"))
    content.milliseconds, content.frames = 12.3, 40.0
    return content


def test_empty_content_is_false() -> None:
    assert not Content()
    assert lines_of(Content(), ALL, 1.0) == {}
    assert texts_of(Content(), ALL, str) == []
    assert full()


def test_switches_hide_lines_and_texts() -> None:
    assert set(lines_of(full(), ALL, 1.0)) == {"contact", "blocked", "clearance"}
    assert lines_of(full(), NONE, 1.0) == {}
    assert texts_of(full(), NONE, str) == []


def test_texts_give_distance_counts_and_speed() -> None:
    assert texts_of(full(), ALL, lambda length: f"{length} m") == [
        "Clearance 5.0 m (Box, Wall)",
        "3 intersecting triangles",
        "2 contacts",
        "12 ms, 40 fps",
    ]


def test_crosses_are_centred_on_their_points() -> None:
    ends = crosses(np.array([[1.0, 2.0, 3.0]]), 0.5).reshape(3, 2, 3)
    assert ends.mean(axis=1) == pytest.approx(np.tile([1.0, 2.0, 3.0], (3, 1)))
    assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) == pytest.approx(1.0)


@pytest.mark.parametrize("direction", [(1, 0, 0), (0, -1, 0), (0.6, 0, -0.8), (3**-0.5, 3**-0.5, 3**-0.5)])
def test_arrows_point_along_their_directions(direction: tuple[float, float, float]) -> None:
    start, unit = np.array([[1.0, 1.0, 1.0]]), np.array([direction])
    shaft, *barbs = arrows(start, unit, 2.0).reshape(3, 2, 3)
    assert shaft[0] == pytest.approx(start[0])
    assert shaft[1] - shaft[0] == pytest.approx(2.0 * unit[0])
    for barb in barbs:
        assert barb[0] == pytest.approx(shaft[1])
        assert 0 < (barb[0] - barb[1]) @ unit[0] < 2.0  # it goes back
