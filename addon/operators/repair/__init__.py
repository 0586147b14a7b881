# SPDX-License-Identifier: GPL-3.0-or-later
"""Resolving intersections: repair, contraction, expansion, exclusions, the last clear state."""
