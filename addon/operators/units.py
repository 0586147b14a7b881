# SPDX-License-Identifier: GPL-3.0-or-later
"""Typed text to values in the units of the scene."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from ..lengths import SCENE_LENGTHS, unit_length
from ..modal.expression import Units, evaluate

# Only these are ever handed to Blender, which evaluates what it is given as Python.
LENGTHS = (
    *("km", "hm", "dam", "m", "dm", "cm", "mm", "um", "µm", "nm"),
    *("kilometer", "kilometers", "meter", "meters", "centimeter", "centimeters", "millimeter", "millimeters"),
    *("mi", "mile", "miles", "yd", "yard", "yards", "ft", "foot", "feet", "in", "inch", "inches", "thou", "mil"),
    *("'", '"'),
)
ANGLES = ("°", "d", "deg", "degree", "degrees", "r", "rad", "radian", "radians", "'", '"')
DEFAULT_LENGTHS = {"METRIC": "m", "IMPERIAL": "ft"}


def readers(scene: Any) -> Mapping[str, Callable[[str], float]]:
    """For each kind of transform, what reads its typed text. They raise ValueError."""
    settings = scene.unit_settings
    lengths, angles = _lengths(settings), _angles(settings)
    return {
        "move": lambda text: evaluate(text, lengths),
        "rotate": lambda text: evaluate(text, angles),
        "scale": lambda text: evaluate(text, lambda name: None if name else 1.0),
    }


def _lengths(settings: Any) -> Units:
    system, scale = settings.system, settings.scale_length or 1.0
    if system == "NONE":
        return lambda name: None if name else 1.0
    usual = SCENE_LENGTHS.get(settings.length_unit, DEFAULT_LENGTHS[system])

    def factor(name: str) -> float | None:
        name = name or usual
        return unit_length(system, name) / scale if name in LENGTHS else None

    return factor


def _angles(settings: Any) -> Units:
    usual = 1.0 if settings.system_rotation == "RADIANS" else math.radians(1.0)

    def factor(name: str) -> float | None:
        if not name:
            return usual
        # Blender knows the units by their short names alone.
        short = {"deg": "d", "degree": "d", "degrees": "d", "rad": "r", "radian": "r", "radians": "r"}.get(name, name)
        return unit_length("METRIC", short, "ROTATION") if name in ANGLES else None

    return factor
