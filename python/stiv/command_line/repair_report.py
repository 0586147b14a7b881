# SPDX-License-Identifier: GPL-3.0-or-later
"""Options and report of `stiv repair` (python/stiv/schemas/repair.schema.json)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

SCHEMA, VERSION = "stiv-repair", 1
LISTED_PAIRS = 100  # in the report
SHOWN_PAIRS = 10  # on the terminal

Element = tuple[str, str, int]  # object, kind of element, index within the object


@dataclass(frozen=True)
class RepairChoices:
    """Options of a repair. stiv.RepairOptions describes those that it also has.

    move: names of objects that may change; empty: all that intersect. time_limit: seconds, 0 for no limit. guard:
    "viewport", "render" or "both"; "" for the setting of the scene.
    """

    move: tuple[str, ...] = ()
    weld: bool = False
    separation: float = 0.0
    max_deviation: float = 0.05
    time_limit: float = 0.0
    guard: str = ""


@dataclass(frozen=True)
class RepairOutcome:
    """Result of the repair of a file; `pairs` still intersect."""

    status: str
    message: str
    pairs_before: int
    pairs: list[tuple[Element, Element]]
    deviation: float
    contracted: str

    @property
    def free(self) -> bool:
        """Whether the output is written and free of intersections."""
        return self.status in ("already_free", "repaired")

    def as_json(self, source: Path, output: Path, seconds: float) -> dict[str, Any]:
        """The report, as JSON data."""
        return {
            "schema": SCHEMA,
            "version": VERSION,
            "file": source.name,
            "output": output.name if self.free else None,
            "status": self.status,
            "free": self.free,
            "message": self.message,
            "pairs_before": self.pairs_before,
            "pairs_left": len(self.pairs),
            "pairs": [{"first": _named(a), "second": _named(b)} for a, b in self.pairs[:LISTED_PAIRS]],
            "deviation": self.deviation,
            "contracted": self.contracted,
            "seconds": seconds,
        }


def _named(element: Element) -> dict[str, Any]:
    name, kind, number = element
    return {"object": name, "kind": kind, "number": number}
