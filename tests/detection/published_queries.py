# SPDX-License-Identifier: GPL-3.0-or-later
"""The format of the collision queries of Wang et al. 2021: eight lines per query, one vertex per line."""

from fractions import Fraction
from pathlib import Path

KINDS = {"vertex-face": "vf", "edge-edge": "ee"}
"""By the name of the folder."""


def read(path: Path) -> tuple[list[list[list[Fraction]]], list[bool]]:
    """Eight points per query, of three fractions each, and whether the pair collides."""
    lines = [[int(number) for number in line.split(",")] for line in path.read_text().splitlines() if line]
    points = [[Fraction(line[k], line[k + 1]) for k in (0, 2, 4)] for line in lines]
    return [points[k : k + 8] for k in range(0, len(points), 8)], [bool(line[6]) for line in lines[::8]]
