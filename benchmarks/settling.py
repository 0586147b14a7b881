# SPDX-License-Identifier: GPL-3.0-or-later
"""Answers settled until nothing changes: what a solver's early end costs, apart from which answer it heads for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import stiv

Array = NDArray[np.float64]
MOST_CALLS = 50
LEAST_GAIN = 1e-6  #: a call that lowers the energy by less of it than this changes nothing


@dataclass(frozen=True)
class Settled:
    """Where settling ended."""

    energy: float
    calls: int  #: MOST_CALLS: it was still changing


def settle(session: stiv.EditSession, energy: float, most: int = MOST_CALLS) -> Settled:
    """Settle the last edit of a session, which came to `energy`, until nothing changes."""
    for call in range(1, most + 1):
        result = session.settle()
        if result.energy > (1 - LEAST_GAIN) * energy:
            return Settled(min(result.energy, energy), call)
        energy = result.energy
    return Settled(energy, most)


def settle_from(session: stiv.EditSession, controls: Array, goal: Array, most: int = MOST_CALLS) -> Settled:
    """Settle from accepted controls of any origin toward a goal, (m, 3) each."""
    session.restore(controls, goal)
    return settle(session, session.drag(goal).energy, most)


def stopped_energy(surface: stiv.Surface, start: Array, goal: Array, separation: float) -> float:
    """E where the straight step between two surfaces, (N, 3) each, stops before it comes within the separation."""
    time = min(stiv.Detector(surface).earliest_time(start, goal, separation), 1.0)
    return 0.5 * float(((1 - time) * (goal - start) ** 2 * (1 - time)).sum())


def geometric_mean(values: list[float]) -> float:
    """Geometric mean of positive values."""
    return float(np.exp(np.mean(np.log(values))))
