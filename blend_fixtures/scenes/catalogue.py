# SPDX-License-Identifier: GPL-3.0-or-later
"""All fixtures by name."""

from __future__ import annotations

from .cages import cage_with_creases_and_boundary, self_folding_sheet
from .fixture import Fixture
from .handles import arm_with_handles
from .lattices import INTERPOLATIONS, lattice_of_type, lattice_then_subdivision
from .plant_in_vase import plant_in_vase
from .pressing import (
    box_along_wall,
    cage_into_wavy_wall,
    coplanar_plates,
    plate_with_modifiers,
    rigid_ellipsoid,
    sheet_through_sheet,
    sphere_along_wall,
)


def all_fixtures() -> tuple[Fixture, ...]:
    """All fixtures, newly built, in a fixed order."""
    return (
        cage_into_wavy_wall(),
        sheet_through_sheet(),
        box_along_wall(),
        sphere_along_wall(),
        plant_in_vase(),
        rigid_ellipsoid(),
        self_folding_sheet(),
        coplanar_plates(),
        cage_with_creases_and_boundary(),
        *(lattice_of_type(interpolation) for interpolation in INTERPOLATIONS),
        lattice_then_subdivision(),
        arm_with_handles(),
        plate_with_modifiers(),
    )
