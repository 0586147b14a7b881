# SPDX-License-Identifier: GPL-3.0-or-later
"""The classes of all operators, and their order in menus and panels."""

from .check.check import STIV_OT_check
from .check.measure import STIV_OT_measure
from .layout.drop import STIV_OT_drop
from .layout.fit_into import STIV_OT_fit_into
from .layout.place import STIV_OT_place
from .layout.push_apart import STIV_OT_push_apart
from .layout.settle_contact import STIV_OT_settle_contact
from .repair.contract import STIV_OT_contract
from .repair.exclusions import STIV_OT_clear_exclusions, STIV_OT_exclude_intersections
from .repair.expand import STIV_OT_expand
from .repair.guard_revert import STIV_OT_guard_revert
from .repair.passing import STIV_OT_let_pass, STIV_OT_let_pass_remove
from .repair.popup import STIV_OT_popup
from .repair.repair import STIV_OT_repair
from .repair.separate import STIV_OT_separate
from .repair.settle import STIV_OT_settle
from .setup.handles import STIV_OT_handle_add, STIV_OT_handle_remove
from .setup.loop import STIV_OT_loop_add, STIV_OT_loop_refresh, STIV_OT_loop_remove
from .setup.pair_distances import STIV_OT_separation_add, STIV_OT_separation_remove
from .transform.drag import STIV_OT_drag
from .transform.morph import STIV_OT_morph
from .transform.morph_drag import STIV_OT_morph_drag
from .transform.move import STIV_OT_move
from .transform.rotate import STIV_OT_rotate
from .transform.scale import STIV_OT_scale
from .transform.start_drag import STIV_OT_live_transform, STIV_OT_transform

TRANSFORMS = (STIV_OT_move, STIV_OT_rotate, STIV_OT_scale)
RESHAPING = (STIV_OT_repair, STIV_OT_contract, STIV_OT_expand, STIV_OT_settle)
LAYOUT_ICONS = (
    (STIV_OT_drop, "SORT_ASC"),
    (STIV_OT_settle_contact, "SNAP_FACE"),
    (STIV_OT_place, "OUTLINER_OB_POINTCLOUD"),
    (STIV_OT_push_apart, "FULLSCREEN_ENTER"),
    (STIV_OT_fit_into, "PACKAGE"),
)
LAYOUT = tuple(operator for operator, _ in LAYOUT_ICONS)
CLASSES = (
    *TRANSFORMS,
    STIV_OT_drag,
    STIV_OT_transform,
    STIV_OT_live_transform,
    STIV_OT_check,
    STIV_OT_measure,
    STIV_OT_morph,
    STIV_OT_morph_drag,
    *LAYOUT,
    *RESHAPING,
    STIV_OT_popup,
    STIV_OT_separate,
    STIV_OT_let_pass,
    STIV_OT_let_pass_remove,
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
