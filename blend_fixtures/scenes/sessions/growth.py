# SPDX-License-Identifier: GPL-3.0-or-later
"""One scene at four resolutions: a hilly body in a lattice, scaled up inside a shell."""

from __future__ import annotations

import stiv

from ..detection_steps import rounded_box
from .session import Session, Stage, repeated, scaled, single, surface_of

# : Cuts of body and shell: 10, 76, 299 and 1,196 thousand triangles.
SIZES = ((24, 16), (66, 44), (131, 88), (262, 176))
GAP, ROUGHNESS, GROWTH, EDITS = 0.026, 0.02, 1.0015, 10


def stage(fine: int, coarse: int) -> Stage:
    """The body grows, starting just before the first contact; its hills are higher than those of the shell."""
    turn = (0.3, 0.2, 0.1)
    body = rounded_box(fine, 0.1 + ROUGHNESS).turned(turn)
    shell = rounded_box(coarse, 0.1, 1 + GAP).turned(turn)
    surface, start = surface_of({"Body": body, "Shell": shell}, {"Shell": "fixed"})
    moves = range(len(body.vertices))
    frame = [[0.35, 0, 0, 0], [0, 0.35, 0, 0], [0, 0, 0.35, 0], [0, 0, 0, 1]]
    weights = stiv.lattice(body.vertices, (8, 8, 8), frame=frame)
    points = 0.35 * stiv.lattice_rest_points((8, 8, 8))
    name = f"{len(surface.triangles)} triangles"
    return Stage(
        name, surface, stiv.concatenate([(weights, list(moves))], start), points, repeated(scaled(GROWTH), EDITS)
    )


def growth_sessions(largest: int) -> tuple[Session, ...]:
    """The sizes of up to `largest` triangles."""
    chosen = [(fine, coarse) for fine, coarse in SIZES if 12 * (fine**2 + coarse**2) <= largest]
    return tuple(
        Session(
            f"growth {12 * (f * f + c * c)}", 9, "A body scaled up inside a shell", single(lambda f=f, c=c: stage(f, c))
        )
        for f, c in chosen
    )
