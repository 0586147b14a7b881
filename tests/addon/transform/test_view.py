# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from views import SIZE, VIEWS, looking

from stiv_addon.transform.view import View

POINT = np.array([0.3, -0.4, 0.5])


@pytest.mark.parametrize("view", VIEWS.values(), ids=VIEWS)
def test_the_position_beside_a_pixel_is_seen_at_that_pixel(view: View) -> None:
    for pixel in [(0.0, 0.0), (400.0, 300.0), (123.0, 456.0)]:
        at_depth_of = view.at_depth_of(pixel, POINT)
        assert view.project(at_depth_of) == pytest.approx(pixel, abs=1e-6)
        assert (at_depth_of - POINT) @ (view.ray((400.0, 300.0), POINT)[1]) == pytest.approx(0.0, abs=1e-6)


def test_the_target_is_seen_in_the_middle() -> None:
    for parallel in (False, True):
        view = looking((3, 2, 1), (1, 1, 1), parallel=parallel)
        assert view.project(np.ones(3)) == pytest.approx((SIZE[0] / 2, SIZE[1] / 2))


def test_a_position_behind_the_viewer_has_no_pixel() -> None:
    assert looking((0, 0, 10)).project(np.array([0.0, 0.0, 11.0])) is None


@pytest.mark.parametrize("eye", [(0, 0, 10), (6, -5, 4), (-3, 1, -2)])
def test_the_direction_to_the_viewer_is_that_of_the_eye(eye: tuple) -> None:
    expected = (np.array(eye) - POINT) / np.linalg.norm(np.array(eye) - POINT)
    np.testing.assert_allclose(looking(eye).toward_viewer(POINT), expected, atol=1e-9)
