# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn over the 3D view: contacts, intersecting faces, clearance, speed.

content: what there is to draw, as plain arrays; drawing: lines, triangles and text from it; display: when.
"""
