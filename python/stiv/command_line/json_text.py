# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON for people and programs: a line a value, but what is a list of plain values takes one line in all."""

from __future__ import annotations

import json
from typing import Any

INDENT = "  "


def json_text(data: Any, indent: str = "") -> str:
    """`data` as JSON that `json.loads` reads back as it was; `indent` is that of the line it begins on."""
    inner = indent + INDENT
    if isinstance(data, dict) and data:
        lines = [f"{_plain(str(key))}: {json_text(value, inner)}" for key, value in data.items()]
        return _block("{", lines, "}", indent)
    if isinstance(data, list | tuple) and any(isinstance(value, dict | list | tuple) for value in data):
        return _block("[", [json_text(value, inner) for value in data], "]", indent)
    return _plain(data)


def _block(begin: str, lines: list[str], end: str, indent: str) -> str:
    separator = f",\n{indent}{INDENT}"
    return f"{begin}\n{indent}{INDENT}{separator.join(lines)}\n{indent}{end}"


def _plain(data: Any) -> str:
    return json.dumps(data, ensure_ascii=False)
