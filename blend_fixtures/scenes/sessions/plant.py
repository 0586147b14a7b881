# SPDX-License-Identifier: GPL-3.0-or-later
"""Figure 8: shoots in a tri-cubic lattice, lowered into a vase, then scaled."""

from __future__ import annotations

from ..plant_in_vase import plant_in_vase
from .lattice_stage import lattice_stage
from .session import Session, single


def session() -> Session:
    """The fixture's edits without Blender."""
    return Session(
        "plant", 8, "Shoots lowered into a vase, then scaled", single(lambda: lattice_stage(plant_in_vase()))
    )
