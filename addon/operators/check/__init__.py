# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersections and clearances of the scene as it is."""
