# SPDX-License-Identifier: GPL-3.0-or-later
"""What every operator with geometry shares: without the native module it is greyed out, and says why."""

from __future__ import annotations

import bpy

from .. import availability


class NeedsNativeModule:
    """Base of an operator; a subclass says in `fits` what else it needs."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """With the native module, where the operator fits."""
        problem = availability.problem()
        if problem:
            cls.poll_message_set(problem)
            return False
        return cls.fits(context)

    @classmethod
    def fits(cls, context: bpy.types.Context) -> bool:
        """Everywhere, unless a subclass says otherwise."""
        return True
