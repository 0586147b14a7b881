# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab "STIV" in the sidebar of the 3D view; the other panels are within the first panel."""

from .check import STIV_PT_check, STIV_PT_overlay, STIV_PT_repair
from .edit import STIV_PT_edit
from .getting_started import STIV_PT_getting_started
from .guard import STIV_PT_guard, STIV_PT_guard_state
from .layout import STIV_PT_layout
from .objects import STIV_PT_deformation, STIV_PT_loop, STIV_PT_roles, STIV_PT_separation, STIV_PT_shape_keys

CLASSES = (
    STIV_PT_getting_started,
    STIV_PT_edit,
    STIV_PT_guard,
    STIV_PT_layout,
    STIV_PT_guard_state,
    STIV_PT_roles,
    STIV_PT_deformation,
    STIV_PT_shape_keys,
    STIV_PT_loop,
    STIV_PT_separation,
    STIV_PT_check,
    STIV_PT_repair,
    STIV_PT_overlay,
)
