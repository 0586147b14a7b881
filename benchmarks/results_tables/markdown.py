# SPDX-License-Identifier: GPL-3.0-or-later
"""The results' JSON files, and how their numbers become Markdown."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from benchmarks.sessions.table1 import PUBLISHED

FOLDER = Path(__file__).parents[1] / "results"
SCENES = tuple(PUBLISHED)


def loaded(name: str) -> Any:
    """The content of one JSON file."""
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def number(value: float) -> str:
    """Two or three digits, without an exponent."""
    return f"{value:.0f}" if value >= 20 else f"{value:.2g}" if value < 10 else f"{value:.1f}"
