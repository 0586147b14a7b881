# SPDX-License-Identifier: GPL-3.0-or-later
"""The materials that all fixtures share, for consistent pictures."""

from .fixture import Material

MOVING = Material("Moving", (1.0, 0.50, 0.14, 1.0), 0.4)
SECOND = Material("Second", (0.95, 0.80, 0.22, 1.0), 0.45)
STILL = Material("Still", (0.42, 0.58, 0.80, 1.0), 0.6)
GRASS = Material("Grass", (0.30, 0.70, 0.12, 1.0), 0.5)
GLAZE = Material("Glaze", (0.35, 0.72, 0.95, 0.40), 0.2)
FUR = Material("Fur", (0.78, 0.60, 0.42, 1.0), 0.7)
BARK = Material("Bark", (0.40, 0.26, 0.15, 1.0), 0.8)
LEAF = Material("Leaf", (0.22, 0.58, 0.16, 1.0), 0.6)
SKIN = Material("Skin", (0.55, 0.68, 0.38, 1.0), 0.6)
CLOTH = Material("Cloth", (0.80, 0.24, 0.22, 1.0), 0.7)
HORN = Material("Horn", (0.12, 0.12, 0.14, 1.0), 0.3)
FELT = Material("Felt", (0.20, 0.22, 0.50, 1.0), 0.8)
ORGANS = tuple(
    Material(name, (*color, 1.0), 0.4)
    for name, color in {
        "Liver": (0.45, 0.12, 0.08),
        "Stomach": (0.86, 0.55, 0.42),
        "Heart": (0.72, 0.10, 0.12),
        "Left lung": (0.90, 0.62, 0.60),
        "Right lung": (0.88, 0.58, 0.58),
        "Left kidney": (0.60, 0.24, 0.20),
        "Right kidney": (0.62, 0.26, 0.20),
        "Spleen": (0.48, 0.16, 0.30),
        "Gut": (0.92, 0.70, 0.52),
    }.items()
)
