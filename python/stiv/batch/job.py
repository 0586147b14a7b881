# SPDX-License-Identifier: GPL-3.0-or-later
"""Job files: scenes, a command for each, and output files. docs/batch.md describes the format."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stiv import InputError
from stiv.choices import GUARDS
from stiv.frame_ranges import parse_frames
from stiv.json_files import read_json, require_format
from stiv.output_files import resolved

SCHEMA, VERSIONS = "stiv-batch", (1, 2)
RENAMED = {"do": "command"}  # fields of version 1 by their present names
MAX_BYTES = 64 * 2**20
MAX_NAME = 100

_FILES_IN = ("scene", "edits", "baseline")
_FILES_OUT = ("output", "report")
_FIELDS: Mapping[str, tuple[set[str], set[str]]] = {  # by command: required and optional fields
    "check": ({"scene"}, {"report", "frames", "objects", "baseline", "scene_name", "render", "hidden", "guard"}),
    "replay": ({"scene", "edits", "output"}, {"report", "guard"}),
    "repair": ({"scene", "output"}, {"report", "guard"}),
    "resolve": ({"scene", "frames", "output"}, {"report", "hold", "guard"}),
}


@dataclass(frozen=True)
class Entry:
    """One scene with its command, as arguments of `stiv`."""

    name: str
    arguments: tuple[str, ...]
    inputs: tuple[Path, ...]
    outputs: tuple[Path, ...]


@dataclass(frozen=True)
class Job:
    """All entries. `time_limit`: seconds for each, 0 for no limit."""

    entries: tuple[Entry, ...]
    time_limit: float = 0.0
    description: str = ""


def read_job(path: Path) -> Job:
    """Reads a job; its paths are relative to its folder. Raises InputError naming file, entry and field."""
    data = read_json(path, MAX_BYTES)
    try:
        return parse_job(data, resolved(path).parent)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def parse_job(data: object, folder: Path) -> Job:
    """The job of parsed JSON. Raises InputError naming entry and field."""
    fields = require_format(data, SCHEMA, VERSIONS)
    _refuse_unknown(fields, {"schema", "version", "description", "time_limit", "entries"}, "the job")
    entries = fields.get("entries")
    if not isinstance(entries, list):
        raise InputError('the field "entries" is not a list')
    renamed = RENAMED if fields["version"] == 1 else {}
    parsed = tuple(_entry(entry, f"entry {number}", folder, renamed) for number, entry in enumerate(entries))
    _refuse_clashes(parsed)
    description = _text(fields.get("description", ""), "description", "the job")
    return Job(parsed, _seconds(fields.get("time_limit", 0)), description)


def _entry(given: object, where: str, folder: Path, renamed: Mapping[str, str]) -> Entry:
    if not isinstance(given, dict):
        raise InputError(f"{where}: not an object with named fields")
    data = {renamed.get(name, name): value for name, value in given.items()}
    name = _text(data.get("name"), "name", where)
    if not name or len(name) > MAX_NAME or not name.isprintable():
        raise InputError(f'{where}: "name" must have 1 to {MAX_NAME} printable characters')
    where = f'{where} ("{name}")'
    command = data.get("command")
    if not isinstance(command, str) or command not in _FIELDS:
        raise InputError(f'{where}: "command" is {command!r}, none of {", ".join(_FIELDS)}')
    required, optional = _FIELDS[command]
    for field in sorted(required - set(data)):
        raise InputError(f'{where}: {command} needs the field "{field}"')
    _refuse_unknown(data, {"name", "command"} | required | optional, where)
    files = {f: folder / _path(data[f], f, where) for f in (*_FILES_IN, *_FILES_OUT) if f in data}
    return Entry(
        name,
        tuple(_arguments(command, data, files, where)),
        tuple(files[field] for field in _FILES_IN if field in files),
        tuple(files[field] for field in _FILES_OUT if field in files),
    )


def _arguments(command: str, data: Mapping[str, Any], files: Mapping[str, Path], where: str) -> list[str]:
    """The arguments of `stiv`. Options take their values after "=", because a value may begin with a dash."""
    arguments = [command, str(files["scene"])]
    if "edits" in files:
        arguments.append(str(files["edits"]))
    if "output" in files:
        arguments.append(f"--output={files['output']}")
    if "report" in files:
        arguments.append(f"--{'json' if command == 'check' else 'report'}={files['report']}")
    if "baseline" in files:
        arguments.append(f"--baseline={files['baseline']}")
    if "frames" in data:
        arguments.append(f"--frames={_frames(data['frames'], where)}")
    if "scene_name" in data:
        arguments.append(f"--scene={_text(data['scene_name'], 'scene_name', where)}")
    if "guard" in data:
        arguments.append(f"--guard={_guard(data['guard'], where)}")
    arguments += [f"--{field}" for field in ("render", "hidden") if _flag(data.get(field, False), field, where)]
    arguments += [f"--object={name}" for name in _names(data.get("objects", []), "objects", where)]
    return arguments + [f"--hold={name}" for name in _names(data.get("hold", []), "hold", where)]


def _refuse_unknown(data: Mapping[str, Any], known: set[str], where: str) -> None:
    unknown = sorted(set(data) - known)
    if unknown:
        raise InputError(f'{where}: unknown field "{unknown[0]}"; the fields are {", ".join(sorted(known))}')


def _refuse_clashes(entries: tuple[Entry, ...]) -> None:
    """Raises InputError if two entries have one name, or a file is written twice or both read and written."""
    names: dict[str, int] = {}
    written: dict[Path, str] = {}
    for number, entry in enumerate(entries):
        if names.setdefault(entry.name, number) != number:
            raise InputError(f'entry {number}: entry {names[entry.name]} also has the name "{entry.name}"')
        for path in entry.outputs:
            if path in written:
                raise InputError(f'entry {number} ("{entry.name}"): "{written[path]}" also writes {path}')
            written[path] = entry.name
    for number, entry in enumerate(entries):
        for path in entry.inputs:
            if path in written:
                raise InputError(f'entry {number} ("{entry.name}"): reads {path}, which "{written[path]}" writes')


def _path(value: object, field: str, where: str) -> Path:
    text = _text(value, field, where)
    if not text or "\0" in text:
        raise InputError(f'{where}: "{field}" is not the path of a file')
    return Path(text)


def _text(value: object, field: str, where: str) -> str:
    if not isinstance(value, str):
        raise InputError(f'{where}: "{field}" is not a text')
    return value


def _flag(value: object, field: str, where: str) -> bool:
    if not isinstance(value, bool):
        raise InputError(f'{where}: "{field}" is neither true nor false')
    return value


def _guard(value: object, where: str) -> str:
    if value not in GUARDS:
        raise InputError(f'{where}: "guard" is {value!r}, none of {", ".join(GUARDS)}')
    return str(value)


def _names(value: object, field: str, where: str) -> list[str]:
    if not isinstance(value, list) or not all(isinstance(name, str) for name in value):
        raise InputError(f'{where}: "{field}" is not a list of object names')
    return value


def _frames(value: object, where: str) -> str:
    try:
        parse_frames(_text(value, "frames", where))
    except ValueError as error:
        raise InputError(f"{where}: {error}") from error
    return str(value)


def _seconds(value: object) -> float:
    if (
        not isinstance(value, int | float)
        or isinstance(value, bool)
        or not 0 <= value < 1e9
        or not math.isfinite(value)
    ):
        raise InputError('the job: "time_limit" is not a number of seconds')
    return float(value)
