# SPDX-License-Identifier: GPL-3.0-or-later
"""Lays out rigid objects: drops, settles, parts, spreads and packs them without intersections."""
