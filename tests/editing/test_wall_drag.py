# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes dragged along a wall while the mouse moves deep into the wall and back."""

from __future__ import annotations

import pytest

from benchmarks.wall_drag import drag_along_wall


@pytest.mark.parametrize("shape", ["box", "sphere"])
def test_a_drag_along_a_wall_preserves_its_travel_and_returns(shape: str) -> None:
    result = drag_along_wall(shape)
    assert result.intersections == 0
    assert result.travel == pytest.approx(2.0, rel=1e-3 if shape == "box" else 0.03)
    assert result.drift < 1e-3
    assert result.gap_at_wall < 2e-3  # it stays on the wall until the mouse returns to it
    assert result.free_at_end == pytest.approx(0.2, abs=1e-6)
    assert result.return_error < 1e-6
