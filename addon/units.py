# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths and angles in the units of the scene: to text, and from what is typed."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping

import bpy

from .modal.expression import Units, evaluate
from .modal.header_texts import DIGITS, fixed_text

SCENE_LENGTHS = {
    "KILOMETERS": "km", "METERS": "m", "CENTIMETERS": "cm", "MILLIMETERS": "mm", "MICROMETERS": "um",
    "MILES": "mi", "FEET": "ft", "INCHES": "in", "THOU": "thou",
}  # fmt: skip


def length_text(value: float, units: bpy.types.UnitSettings, digits: int = DIGITS) -> str:
    """A length with its unit and a fixed number of digits: "0.0000 m", "1.500 cm".

    value: in world units. units: the scene's `unit_settings`. A value that rounds to zero has no sign.
    """
    if units.system == "NONE":
        return fixed_text(value, digits)
    value *= units.scale_length
    name = SCENE_LENGTHS.get(units.length_unit) or _adaptive_unit(value, units.system)
    space = " " if name.isalpha() else ""
    return f"{fixed_text(value / unit_length(units.system, name), digits)}{space}{name}"


def _adaptive_unit(value: float, system: str) -> str:
    """The unit that Blender chooses for a length in metres: "cm", or "'" for feet."""
    return str(bpy.utils.units.to_string(system, "LENGTH", value, precision=DIGITS)).lstrip("-.0123456789 ")


@functools.cache
def unit_length(system: str, name: str, category: str = "LENGTH") -> float:
    """The factor of a unit by its short name, in metres, or in radians for the category "ROTATION".

    Blender calculates in single precision, so seven digits are significant.
    """
    return float(f"{bpy.utils.units.to_value(system, category, '1' + name):.7g}")


# Only these names are passed to Blender, which evaluates its argument as Python.
LENGTHS = (
    *("km", "hm", "dam", "m", "dm", "cm", "mm", "um", "µm", "nm"),
    *("kilometer", "kilometers", "meter", "meters", "centimeter", "centimeters", "millimeter", "millimeters"),
    *("mi", "mile", "miles", "yd", "yard", "yards", "ft", "foot", "feet", "in", "inch", "inches", "thou", "mil"),
    *("'", '"'),
)
ANGLES = ("°", "d", "deg", "degree", "degrees", "r", "rad", "radian", "radians", "'", '"')
DEFAULT_LENGTHS = {"METRIC": "m", "IMPERIAL": "ft"}


def readers(scene: bpy.types.Scene) -> Mapping[str, Callable[[str], float]]:
    """The functions that read typed text, by kind of transform. They raise ValueError."""
    settings = scene.unit_settings
    lengths, angles = _lengths(settings), _angles(settings)
    return {
        "move": lambda text: evaluate(text, lengths),
        "rotate": lambda text: evaluate(text, angles),
        "scale": lambda text: evaluate(text, lambda name: None if name else 1.0),
    }


def _lengths(settings: bpy.types.UnitSettings) -> Units:
    system, scale = settings.system, settings.scale_length or 1.0
    if system == "NONE":
        return lambda name: None if name else 1.0
    default = SCENE_LENGTHS.get(settings.length_unit, DEFAULT_LENGTHS[system])

    def factor(name: str) -> float | None:
        name = name or default
        return unit_length(system, name) / scale if name in LENGTHS else None

    return factor


def _angles(settings: bpy.types.UnitSettings) -> Units:
    default = 1.0 if settings.system_rotation == "RADIANS" else math.radians(1.0)

    def factor(name: str) -> float | None:
        if not name:
            return default
        # Blender only accepts the short names of these units.
        short = {"deg": "d", "degree": "d", "degrees": "d", "rad": "r", "radian": "r", "radians": "r"}.get(name, name)
        return unit_length("METRIC", short, "ROTATION") if name in ANGLES else None

    return factor
