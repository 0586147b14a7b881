# SPDX-License-Identifier: GPL-3.0-or-later
"""The overlay of the 3D view: contacts, intersecting faces, clearance, speed.

content: plain arrays to draw; drawing: lines, triangles and text; display: when to draw them;
guides: axes, circle and line to the pointer of a drag.
"""
