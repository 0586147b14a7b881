# SPDX-License-Identifier: GPL-3.0-or-later
"""What the last edit did, in numbers, for scripts: the operator's return value has no room for it."""

from __future__ import annotations

import json
from typing import Any

_written = 0


def note_written(owner: Any, context: Any) -> None:
    """Called by Blender whenever the description of an edit is stored."""
    global _written
    _written += 1


def written() -> int:
    """How many edits the operators have written since the extension was loaded."""
    return _written


def describe(result: Any, report: Any) -> str:
    """JSON of a `stiv.EditResult` and of the report on what was written."""
    return json.dumps(
        {
            "status": result.status,
            **numbers(result),
            "blocking": list(result.blocking),
            "shown": bool(report.passed),
            "message": str(report.message),
        }
    )


def numbers(result: Any) -> dict[str, Any]:
    """What a `stiv.EditResult` came to and took, ready for JSON."""
    return {
        "rounds": int(result.rounds),
        "events": len(result.events.kind),
        "patches": int(result.patches),
        "energy": float(result.energy),
        "timings": {name: float(value) for name, value in result.timings.items()},
        "counters": {name: int(value) for name, value in result.counters.items()},
    }
