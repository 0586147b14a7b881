# SPDX-License-Identifier: GPL-3.0-or-later
"""The values of every choice of the add-on, `stiv.blender` and the command line. Each is declared here only.

The first value of each is its default.
"""

OPERATORS = ("move", "rotate", "scale")  #: kinds of edit
RESPONDERS = ("selected", "unselected", "all")  #: which side moves out of the way
OBJECT_RESPONSES = ("slide", "slide_and_turn", "deform")  #: how objects respond to contact in Object Mode
FORMER_RESPONSES = {"rigid": "slide_and_turn"}  #: values of version 0.1.0, which files may contain
ROLES = ("auto", "controls", "rigid", "obstacle", "ignored")  #: how an object participates
DEFORMATIONS = ("auto", "vertices", "laplacian", "arap", "lattice", "rigid")  #: how an object deforms on contact
RESTS = ("follows", "stays")  #: vertices that are neither a handle nor anchored
BOUNDARIES = ("all", "preserve_corners")  #: corners of a subdivided boundary: all are rounded, or they stay
GUARDS = ("auto", "viewport", "render", "both")  #: evaluations that stay free of intersections
