# SPDX-License-Identifier: GPL-3.0-or-later
"""The sessions of the paper's figures and of its Table 1, by name and in the order of the table."""

from __future__ import annotations

from . import dressing, hare_in_pot, knot, plant, tree_in_corner
from .session import Session


def figure_sessions() -> dict[str, Session]:
    """Plant, hare (the paper's bunny), tree, knot and dressing (its ogre), in the steps of the .blend fixtures."""
    modules = (plant, hare_in_pot, tree_in_corner, knot, dressing)
    return {session.name: session for session in (module.session() for module in modules)}


def table_sessions() -> dict[str, Session]:
    """The same five with at least as many contacts per round as in Table 1: tree and knot take larger steps."""
    return {**figure_sessions(), "tree": tree_in_corner.large_moves(), "knot": knot.large_moves()}
