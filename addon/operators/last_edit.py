# SPDX-License-Identifier: GPL-3.0-or-later
"""The last edit in numbers, for scripts: the return value of an operator cannot hold them."""

from __future__ import annotations

import json

from .. import stiv_blender

_written = 0


def note_written(owner: object, context: object) -> None:
    """Called by Blender whenever the description of an edit is stored."""
    global _written
    _written += 1


def written() -> int:
    """Number of edits that the operators have written since the extension was loaded."""
    return _written


def describe(result: stiv_blender.EditResult, report: stiv_blender.WriteReport) -> str:
    """JSON of a result and of the report on writing it."""
    return json.dumps(
        {
            "status": result.status,
            **numbers(result),
            "blocking": list(result.blocking),
            "shown": bool(report.passed),
            "message": str(report.message),
        }
    )


def numbers(result: stiv_blender.EditResult) -> dict[str, object]:
    """Counters and timings of a result, ready for JSON."""
    return {
        "rounds": int(result.rounds),
        "events": len(result.events.kind),
        "patches": int(result.patches),
        "energy": float(result.energy),
        "timings": {name: float(value) for name, value in result.timings.items()},
        "counters": {name: int(value) for name, value in result.counters.items()},
    }
