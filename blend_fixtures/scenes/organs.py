# SPDX-License-Identifier: GPL-3.0-or-later
"""Nine closed organ-like shapes as triangle cages, each around the origin, and a bowl to pack them into."""

from __future__ import annotations

import numpy as np

from .fields import Field, ellipsoid, half_space, limb, merged, path, without
from .primitives import triangulated
from .shape import Shape
from .surface_nets import surface_net


def _gut() -> Field:
    """A thick tube with two bends."""
    turn = np.linspace(0, 1, 13)
    line = np.stack([0.38 * np.sin(2 * np.pi * turn), 0 * turn, 0.6 - 1.2 * turn], axis=1)
    return path(line, np.full(13, 0.2))


def _lung(side: float) -> Field:
    upper, lower = ellipsoid((0, 0, 0.15), (0.26, 0.24, 0.42)), ellipsoid((0.06 * side, 0, -0.2), (0.33, 0.3, 0.3))
    return without(merged(upper, lower, smooth=0.15), ellipsoid((-0.42 * side, 0, 0), (0.2, 0.3, 0.35)), smooth=0.12)


def _kidney(side: float) -> Field:
    bean = path([(0, 0, -0.22), (0.09 * side, 0, 0), (0, 0, 0.22)], [0.19, 0.2, 0.19])
    return without(bean, ellipsoid((-0.26 * side, 0, 0), (0.13, 0.3, 0.12)), smooth=0.14)


def organ_fields() -> dict[str, Field]:
    """The organs by name."""
    liver = merged(
        ellipsoid((-0.15, 0, 0), (0.46, 0.34, 0.3)), ellipsoid((0.36, 0, 0.06), (0.34, 0.24, 0.17)), smooth=0.15
    )
    stomach = path(
        [(0.16, 0, 0.4), (0.2, 0, 0.15), (0.12, 0, -0.15), (-0.15, 0, -0.27), (-0.4, 0, -0.2)],
        [0.17, 0.25, 0.26, 0.2, 0.15],
    )
    heart = merged(
        ellipsoid((-0.1, 0, 0.1), (0.24, 0.22, 0.24)),
        limb((0.06, 0, 0.06), (0.1, -0.05, -0.28), 0.24, 0.12),
        smooth=0.1,
    )
    return {
        "Liver": liver,
        "Stomach": stomach,
        "Heart": heart,
        "Left lung": _lung(1.0),
        "Right lung": _lung(-1.0),
        "Left kidney": _kidney(1.0),
        "Right kidney": _kidney(-1.0),
        "Spleen": ellipsoid((0, 0, 0), (0.18, 0.16, 0.3)),
        "Gut": _gut(),
    }


def organs(cell: float = 0.14) -> dict[str, Shape]:
    """A cage for each organ."""
    return {
        name: triangulated(surface_net(field, (-1.0,) * 3, (1.0,) * 3, cell, 8))
        for name, field in organ_fields().items()
    }


def bowl(cell: float = 0.11) -> Shape:
    """A thick-walled bowl, open at the top."""
    outside, inside = ellipsoid((0, 0, -0.05), (1.13, 0.97, 1.13)), ellipsoid((0, 0, -0.05), (0.88, 0.72, 0.88))
    solid = without(outside, inside, half_space(2, 0.35, below=False), smooth=0.08)
    return triangulated(surface_net(solid, (-1.5,) * 3, (1.5,) * 3, cell))
