# SPDX-License-Identifier: GPL-3.0-or-later
"""A typed value and a drag with the same total end in the same place after settling."""

from __future__ import annotations

import numpy as np
import pytest

import stiv
from blend_fixtures.scenes import families
from blend_fixtures.scenes.families import Edit

MOVES = 25


def settled(session: stiv.EditSession) -> np.ndarray:
    """Settle until there is no further gain, as at rest and on confirmation."""
    energy = np.inf
    for _ in range(8):
        result = session.settle()
        if result.energy > (1 - 1e-3) * energy:
            break
        energy = result.energy
    return session.surface


@pytest.mark.parametrize(
    "edit",
    [families.subdivision(0.6, levels=2), families.rigid(0.7), families.bulge(0.8), families.vase(1.5, count=3)],
    ids=lambda edit: edit.name,
)
def test_a_typed_value_and_a_drag_end_within_a_hundredth_of_the_size(edit: Edit) -> None:
    options = stiv.EditOptions(**edit.options)
    typed, dragged = (stiv.EditSession(edit.surface, edit.deformation, edit.controls, options) for _ in range(2))
    typed.edit(edit.goal)
    for share in np.arange(1, MOVES + 1) / MOVES:
        dragged.drag(edit.controls + share * (edit.goal - edit.controls))
    size = np.linalg.norm(np.ptp(typed.surface, axis=0))
    assert np.linalg.norm(settled(typed) - settled(dragged), axis=1).max() < 0.01 * size
