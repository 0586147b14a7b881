# SPDX-License-Identifier: GPL-3.0-or-later
"""Animations without intersections: `stiv resolve`."""
