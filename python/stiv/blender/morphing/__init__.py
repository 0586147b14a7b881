# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves numbers of a scene that Blender turns into surfaces, such as values of shape keys, without intersections."""
