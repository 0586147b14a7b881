# SPDX-License-Identifier: GPL-3.0-or-later
"""Drags of an as-rigid-as-possible ball into a sheet: no drag takes many times the median."""

from __future__ import annotations

import numpy as np

import stiv
from benchmarks.handle_drags import ball_above_sheet, random_offsets


def test_random_drags_are_clear_and_take_at_most_ten_times_their_median_rounds() -> None:
    session, surface, start = ball_above_sheet()
    results = [session.drag(start + offset) for offset in random_offsets(20)]
    assert all(len(stiv.find_intersections(result.surface, surface)) == 0 for result in results)
    rounds = [result.rounds for result in results if result.rounds > 0]
    assert len(rounds) > 6
    assert max(rounds) <= 10 * np.median(rounds)
