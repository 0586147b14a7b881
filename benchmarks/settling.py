# SPDX-License-Identifier: GPL-3.0-or-later
"""Solutions settled until nothing changes, to separate the cost of early termination from the choice of minimum."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import stiv

Array = NDArray[np.float64]
MOST_CALLS = 50
LEAST_GAIN = 1e-6  #: relative decrease of the energy below which a call changes nothing


@dataclass(frozen=True)
class Settled:
    """Where settling ended."""

    energy: float
    calls: int  #: MOST_CALLS: still changing at the end


def settle(session: stiv.EditSession, energy: float, most: int = MOST_CALLS) -> Settled:
    """Settle the last edit of a session, which has this `energy`, until nothing changes."""
    for call in range(1, most + 1):
        result = session.settle()
        if result.energy > (1 - LEAST_GAIN) * energy:
            return Settled(min(result.energy, energy), call)
        energy = result.energy
    return Settled(energy, most)


def settle_from(session: stiv.EditSession, controls: Array, goal: Array, most: int = MOST_CALLS) -> Settled:
    """Settle from any accepted controls toward a goal, (m, 3) each."""
    session.restore(controls, goal)
    return settle(session, session.drag(goal).energy, most)


def stopped_energy(surface: stiv.Surface, start: Array, goal: Array, separation: float) -> float:
    """E if the straight step between two surfaces, (N, 3) each, stops at the separation."""
    time = min(stiv.Detector(surface).earliest_time(start, goal, separation), 1.0)
    return 0.5 * float(((1 - time) * (goal - start) ** 2 * (1 - time)).sum())


def geometric_mean(values: list[float]) -> float:
    """Geometric mean of positive values."""
    return float(np.exp(np.mean(np.log(values))))
