# SPDX-License-Identifier: GPL-3.0-or-later
"""What results of the solver say to the user."""

from __future__ import annotations

from typing import Any

from ..modal.texts import verdict_text


def outcome_text(result: Any) -> str:
    """What became of an edit; an object in the way is named."""
    return verdict_text(result.status, tuple(result.blocking))


def write_failure(report: Any) -> str:
    """Why the accepted state could not be shown, empty if it could (or none was written yet)."""
    return "" if report is None or report.passed else str(report.message)
