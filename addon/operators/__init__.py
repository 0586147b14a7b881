# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators, one a file."""

from .check import STIV_OT_check
from .drag import STIV_OT_drag
from .handles import STIV_OT_handle_add, STIV_OT_handle_remove
from .loop import STIV_OT_loop_add, STIV_OT_loop_refresh, STIV_OT_loop_remove
from .move import STIV_OT_move
from .rotate import STIV_OT_rotate
from .scale import STIV_OT_scale

TRANSFORMS = (STIV_OT_move, STIV_OT_rotate, STIV_OT_scale)
CLASSES = (
    *TRANSFORMS,
    STIV_OT_drag,
    STIV_OT_check,
    STIV_OT_handle_add,
    STIV_OT_handle_remove,
    STIV_OT_loop_add,
    STIV_OT_loop_refresh,
    STIV_OT_loop_remove,
)
