# SPDX-License-Identifier: GPL-3.0-or-later
"""The frame of a drag takes another view if the user navigates, not if the camera moves."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from mathutils import Matrix  # noqa: E402

from stiv_addon.scene.frame import frame_in_new_view  # noqa: E402
from stiv_addon.transform.frame import Frame  # noqa: E402
from stiv_addon.transform.view import View  # noqa: E402

SIZE = (800, 600)


def lens(zoom: float = 1.0) -> Matrix:
    """A perspective window matrix."""
    near, far = 0.1, 100.0
    depth = -(far + near) / (far - near), -2 * far * near / (far - near)
    return Matrix(((2 * zoom, 0, 0, 0), (0, 2.7 * zoom, 0, 0), (0, 0, *depth), (0, 0, -1, 0)))


def placed(angle: float, x: float) -> Matrix:
    """A view matrix."""
    return Matrix.Translation((x, 1, -9)) @ Matrix.Rotation(angle, 4, "X")


def context(zoom: float, angle: float, x: float, perspective: str = "CAMERA", lock: bool = False) -> Any:
    window = lens(zoom)
    data = SimpleNamespace(
        view_perspective=perspective, window_matrix=window, perspective_matrix=window @ placed(angle, x)
    )
    region = SimpleNamespace(width=SIZE[0], height=SIZE[1])
    return SimpleNamespace(region=region, region_data=data, space_data=SimpleNamespace(lock_camera=lock))


@pytest.mark.parametrize(
    ("now", "follows"),
    [
        (context(1.0, 0.4, 2.0), False),
        (context(1.0, 0.9, 2.5), False),  # the camera copies the location of the selection
        (context(1.3, 0.4, 2.0), True),  # zoomed by the wheel
        (context(1.0, 0.4, 2.5, "PERSP"), True),
        (context(1.0, 0.4, 2.5, lock=True), True),
    ],
)
def test_a_drag_follows_navigation_but_no_camera_that_moves(now: Any, follows: bool) -> None:
    """A camera that follows the selection moved it ten times as far as the mouse."""
    frame = Frame(np.zeros(3), view=View(np.array(lens() @ placed(0.4, 2.0)), SIZE))
    found = frame_in_new_view(now, frame)
    assert (found is not frame) == follows
