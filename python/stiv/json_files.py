# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON files: read with limits on untrusted input, written whole or not at all."""

from __future__ import annotations

import json
from collections.abc import Collection
from pathlib import Path
from typing import Any

from stiv import InputError
from stiv.output_files import written_atomically

INDENT = "  "


def read_json(path: Path, max_bytes: int) -> Any:
    """The data of a JSON file in UTF-8. Raises InputError naming the file if it is larger, or not JSON."""
    try:
        if path.stat().st_size > max_bytes:
            raise InputError(f"{path}: larger than the limit of {max_bytes // 2**20} MiB")
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error
    except RecursionError as error:
        raise InputError(f"{path}: nested too deeply") from error
    except InputError:
        raise
    except ValueError as error:
        raise InputError(f"{path}: not JSON in UTF-8: {error}") from error


def require_format(data: object, schema: str, versions: Collection[int]) -> dict[str, Any]:
    """The data of a file of this format. Raises InputError for another format or version."""
    if not isinstance(data, dict) or data.get("schema") != schema:
        raise InputError(f'the field "schema" is not "{schema}"')
    if data.get("version") not in versions:
        supported = " and ".join(map(str, versions))
        raise InputError(f"version {data.get('version')!r} is not supported; this program reads {supported}")
    return data


def write_json(path: Path, data: dict[str, Any]) -> None:
    """Writes `data` as indented JSON. Raises InputError if the file cannot be written."""
    with written_atomically(path) as temporary:
        temporary.write_text(json_text(data) + "\n", encoding="utf-8")


def json_text(data: Any, indent: str = "") -> str:
    """`data` as JSON with one value per line; a list of plain values takes one line.

    `indent` is the indentation of the line on which the text starts.
    """
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
