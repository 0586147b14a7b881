# SPDX-License-Identifier: GPL-3.0-or-later
"""The sessions of the paper's figures and of its Table 1, by name and in the table's order."""

from __future__ import annotations

from . import dressing, hare_in_pot, knot, plant, tree_in_corner
from .session import Session


def figure_sessions() -> dict[str, Session]:
    """Plant, hare (the paper's bunny), tree, knot, dressing (its ogre), in the steps of the .blend fixtures."""
    modules = (plant, hare_in_pot, tree_in_corner, knot, dressing)
    return {session.name: session for session in (module.session() for module in modules)}


def table_sessions() -> dict[str, Session]:
    """The same five, each with at least as many contacts a round as in Table 1: tree and knot in larger steps."""
    return {**figure_sessions(), "tree": tree_in_corner.large_moves(), "knot": knot.large_moves()}
