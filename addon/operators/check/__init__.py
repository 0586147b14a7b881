# SPDX-License-Identifier: GPL-3.0-or-later
"""Intersections and clearances of the current scene."""
