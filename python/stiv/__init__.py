# SPDX-License-Identifier: GPL-3.0-or-later
"""Interference-aware geometric modeling: surfaces that do not go through each other."""

from stiv._native import InputError, StartIntersectsError
from stiv.detection import Detector, Events, find_interference, time_of_impact
from stiv.intersections import find_intersections, find_loose_intersections, is_step_free
from stiv.surface import Body, Surface

__all__ = [
    "Body",
    "Detector",
    "Events",
    "InputError",
    "StartIntersectsError",
    "Surface",
    "find_interference",
    "find_intersections",
    "find_loose_intersections",
    "is_step_free",
    "time_of_impact",
]
