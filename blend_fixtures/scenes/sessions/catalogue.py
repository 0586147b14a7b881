# SPDX-License-Identifier: GPL-3.0-or-later
"""The sessions of the paper's Table 1, by name and in its order."""

from __future__ import annotations

from . import dressing, hare_in_pot, knot, plant, tree_in_corner
from .session import Session


def table_sessions() -> dict[str, Session]:
    """Plant, hare (the paper's bunny), tree, knot, dressing (its ogre)."""
    modules = (plant, hare_in_pot, tree_in_corner, knot, dressing)
    return {session.name: session for session in (module.session() for module in modules)}
