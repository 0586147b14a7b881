# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths as text, in the unit that the scene shows."""

from __future__ import annotations

import functools
from typing import Any

import bpy

from .transform.decimals import DECIMALS, decimal_text

SCENE_LENGTHS = {
    "KILOMETERS": "km", "METERS": "m", "CENTIMETERS": "cm", "MILLIMETERS": "mm", "MICROMETERS": "um",
    "MILES": "mi", "FEET": "ft", "INCHES": "in", "THOU": "thou",
}  # fmt: skip


def length_text(value: float, units: Any, decimals: int = DECIMALS) -> str:
    """A length with its unit: "0 m", "1.5 cm".

    value: in world units. units: the scene's `unit_settings`. decimals: most digits after the point; what rounds to
    zero is written without a sign.
    """
    if units.system == "NONE":
        return decimal_text(value, decimals)
    value *= units.scale_length
    name = SCENE_LENGTHS.get(units.length_unit)
    if name is not None:
        return f"{decimal_text(value / unit_length(units.system, name), decimals)} {name}"
    text = str(bpy.utils.units.to_string(units.system, "LENGTH", value, precision=decimals))  # adaptive
    return text[1:] if text.startswith("-0") and not any(digit in text for digit in "123456789") else text


@functools.cache
def unit_length(system: str, name: str, category: str = "LENGTH") -> float:
    """A unit by its short name, in Blender's own: metres, or radians for the category "ROTATION".

    Blender calculates in single precision, so seven digits are what is meant.
    """
    return float(f"{bpy.utils.units.to_value(system, category, '1' + name):.7g}")
