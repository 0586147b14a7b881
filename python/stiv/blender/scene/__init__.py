# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a Blender scene: its evaluations, meshes, modifiers and strands as plain arrays."""
