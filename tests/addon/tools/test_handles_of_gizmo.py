# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

from stiv_addon.tools.handles import HANDLES, Handle, line_range, opacity, placement

ASKEW = np.array([0.5, 0.5, 0.7])


def visible(*kinds: str) -> list[Handle]:
    return [handle for handle in HANDLES if opacity(handle, frozenset(kinds), ASKEW) > 0.0]


def test_each_tool_has_the_handles_of_blenders() -> None:
    """Counted in Blender's own tools."""
    assert (len(visible("move")), len(visible("rotate")), len(visible("scale"))) == (7, 4, 7)
    combined = visible("move", "rotate", "scale")
    assert not any(handle.plane for handle in combined) and Handle("scale") not in combined
    assert len(combined) == 11


def test_an_arrow_toward_the_viewer_and_a_plane_seen_edge_on_disappear() -> None:
    along_z = np.array([0.0, 0.0, 1.0])
    move = frozenset({"move"})
    assert opacity(Handle("move", 2), move, along_z) == 0.0 and opacity(Handle("move", 0), move, along_z) == 1.0
    assert opacity(Handle("move", 0, plane=True), move, along_z) == 0.0
    assert opacity(Handle("move", 2, plane=True), move, along_z) == 1.0


@pytest.mark.parametrize("handle", [handle for handle in HANDLES if handle.axis >= 0])
def test_a_handle_is_rotated_toward_its_axis_or_plane(handle: Handle) -> None:
    matrix = placement(handle, 0.2)
    turn, axis = matrix[:3, :3], np.eye(3)[handle.axis]
    np.testing.assert_allclose(turn.T @ turn, np.eye(3), atol=1e-15)
    assert np.linalg.det(turn) > 0.0
    np.testing.assert_allclose(turn[:, 1 if handle.plane else 2], axis)
    np.testing.assert_allclose(matrix[:3, 3], 0.2 * turn[:, 2])


def test_lines_of_combined_kinds_do_not_overlap() -> None:
    everything = frozenset({"move", "rotate", "scale"})
    assert line_range("scale", everything)[1] < 1.0 < line_range("move", everything)[0]
