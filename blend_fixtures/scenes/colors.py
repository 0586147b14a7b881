# SPDX-License-Identifier: GPL-3.0-or-later
"""The few materials that all fixtures share, so that pictures look alike."""

from .fixture import Material

MOVING = Material("Moving", (1.0, 0.50, 0.14, 1.0), 0.4)
SECOND = Material("Second", (0.95, 0.80, 0.22, 1.0), 0.45)
STILL = Material("Still", (0.42, 0.58, 0.80, 1.0), 0.6)
GRASS = Material("Grass", (0.30, 0.70, 0.12, 1.0), 0.5)
GLAZE = Material("Glaze", (0.35, 0.72, 0.95, 0.40), 0.2)
