# SPDX-License-Identifier: GPL-3.0-or-later
"""Lengths in the header look like Blender's: in the scene's unit, with fixed decimals, without rounding noise."""

import pytest

bpy = pytest.importorskip("bpy")

from stiv_addon.units import length_text  # noqa: E402

NOISE = -2.656e-08


@pytest.mark.parametrize(
    ("system", "unit", "scale", "value", "expected"),
    [
        ("METRIC", "METERS", 1.0, NOISE, "0.0000 m"),
        ("METRIC", "METERS", 1.0, -0.125, "-0.1250 m"),
        ("METRIC", "CENTIMETERS", 1.0, 1.5, "150.0 cm"),
        ("METRIC", "MILLIMETERS", 0.001, 1.5, "1.500 mm"),
        ("IMPERIAL", "INCHES", 1.0, 0.0254, "1.000 in"),
        ("METRIC", "ADAPTIVE", 1.0, NOISE, "0.0000 m"),
        ("METRIC", "ADAPTIVE", 1.0, 0.25, "25.00 cm"),
        ("METRIC", "METERS", 1.0, 4.344, "4.344 m"),
        ("METRIC", "METERS", 1.0, 12345.678, "12346 m"),
        ("IMPERIAL", "ADAPTIVE", 1.0, 4.344, "14.25'"),
        ("IMPERIAL", "ADAPTIVE", 1.0, 0.001, "39.37 thou"),
        ("NONE", "METERS", 1.0, NOISE, "0.0000"),
        ("NONE", "METERS", 1.0, 100.0, "100.0"),
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
