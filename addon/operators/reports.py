# SPDX-License-Identifier: GPL-3.0-or-later
"""What results of the solver, and what went wrong, say to the user."""

from __future__ import annotations

import traceback
from typing import Any

from ..modal.drag_loop import DragEnded
from ..modal.edit import put_back
from ..modal.header_texts import verdict_text
from ..translations import say


def outcome_text(result: Any) -> str:
    """What became of an edit; an object in the way is named."""
    return verdict_text(result.status, tuple(result.blocking), say)


def write_failure(report: Any) -> str:
    """Why the accepted state could not be shown, empty if it could (or none was written yet)."""
    return "" if report is None or report.passed else str(report.message)


def tell(operator: Any, outcome: str, failure: str) -> None:
    """Report what became of an edit."""
    if failure:
        operator.report({"WARNING"}, failure)
    elif outcome:
        operator.report({"INFO"}, outcome)


def complain(operator: Any, error: Exception, edit: Any) -> set[str]:
    """Report an error with nothing changed. The trace of what nobody expected is printed."""
    from stiv.blender import SceneChangedError  # the add-on registers without the native module

    if edit is not None:
        put_back(edit, error)
    if not isinstance(error, ValueError | SceneChangedError | DragEnded):
        traceback.print_exception(error)
    operator.report({"ERROR"}, "; ".join([str(error) or type(error).__name__, *getattr(error, "__notes__", ())]))
    return {"CANCELLED"}
