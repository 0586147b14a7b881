# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths in the header look like Blender's: in the scene's unit, without rounding noise."""

import math

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

from stiv_addon.transform.rotation import Rotation  # noqa: E402
from stiv_addon.transform.translation import Translation  # noqa: E402
from stiv_addon.units import length_text  # noqa: E402

NOISE = -2.656e-08


@pytest.mark.parametrize(
    ("system", "unit", "scale", "value", "expected"),
    [
        ("METRIC", "METERS", 1.0, NOISE, "0 m"),
        ("METRIC", "METERS", 1.0, -0.125, "-0.125 m"),
        ("METRIC", "CENTIMETERS", 1.0, 1.5, "150 cm"),
        ("METRIC", "MILLIMETERS", 0.001, 1.5, "1.5 mm"),
        ("IMPERIAL", "INCHES", 1.0, 0.0254, "1 in"),
        ("METRIC", "ADAPTIVE", 1.0, NOISE, "0 m"),
        ("METRIC", "ADAPTIVE", 1.0, 0.25, "25 cm"),
        ("NONE", "METERS", 1.0, NOISE, "0"),
        ("NONE", "METERS", 1.0, 100.0, "100"),
    ],
)
def test_a_length_is_written_in_the_unit_of_the_scene(
    system: str, unit: str, scale: float, value: float, expected: str
) -> None:
    units = bpy.data.scenes.new("units").unit_settings
    units.system, units.scale_length = system, scale
    if system != "NONE":
        units.length_unit = unit
    assert length_text(value, units) == expected


def test_the_header_shows_no_rounding_noise() -> None:
    units = bpy.context.scene.unit_settings
    moved = Translation(np.array([1.0, NOISE, 0.0])).text(length=lambda value: length_text(value, units))
    assert moved == "Move X 1 m  Y 0 m  Z 0 m  (distance 1 m)"
    assert Rotation(math.radians(NOISE), np.eye(3)[2]).text() == "Rotate 0°"
