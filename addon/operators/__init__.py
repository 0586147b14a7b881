# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators, one a file."""

from .check import STIV_OT_check
from .contract import STIV_OT_contract
from .drag import STIV_OT_drag
from .exclude import STIV_OT_clear_exclusions, STIV_OT_exclude_intersections
from .expand import STIV_OT_expand
from .guard_revert import STIV_OT_guard_revert
from .handles import STIV_OT_handle_add, STIV_OT_handle_remove
from .loop import STIV_OT_loop_add, STIV_OT_loop_refresh, STIV_OT_loop_remove
from .measure import STIV_OT_measure
from .move import STIV_OT_move
from .repair import STIV_OT_repair
from .rotate import STIV_OT_rotate
from .scale import STIV_OT_scale
from .separation import STIV_OT_separation_add, STIV_OT_separation_remove
from .settle import STIV_OT_settle

TRANSFORMS = (STIV_OT_move, STIV_OT_rotate, STIV_OT_scale)
RESHAPING = (STIV_OT_repair, STIV_OT_contract, STIV_OT_expand, STIV_OT_settle)
CLASSES = (
    *TRANSFORMS,
    STIV_OT_drag,
    STIV_OT_check,
    STIV_OT_measure,
    *RESHAPING,
    STIV_OT_exclude_intersections,
    STIV_OT_clear_exclusions,
    STIV_OT_guard_revert,
    STIV_OT_handle_add,
    STIV_OT_handle_remove,
    STIV_OT_loop_add,
    STIV_OT_loop_refresh,
    STIV_OT_loop_remove,
    STIV_OT_separation_add,
    STIV_OT_separation_remove,
)
