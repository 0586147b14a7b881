# SPDX-License-Identifier: GPL-3.0-or-later
"""Job files: which scenes, what to do with each, where results go. The format: docs/batch.md."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from stiv import InputError
from stiv.choices import GUARDS
from stiv.frame_ranges import parse_frames
from stiv.json_files import read_json

SCHEMA, VERSION = "stiv-batch", 1
MAX_BYTES = 64 * 2**20
MAX_NAME = 100

_FILES_IN = ("scene", "edits", "baseline")
_FILES_OUT = ("output", "report")
_FIELDS: Mapping[str, tuple[set[str], set[str]]] = {  # by what is done: fields that must be there, and that may be
    "check": ({"scene"}, {"report", "frames", "objects", "baseline", "scene_name", "render", "hidden", "guard"}),
    "replay": ({"scene", "edits", "output"}, {"report", "guard"}),
    "repair": ({"scene", "output"}, {"report", "guard"}),
    "resolve": ({"scene", "frames", "output"}, {"report", "hold", "guard"}),
}


@dataclass(frozen=True)
class Entry:
    """One scene and what is done with it, as arguments of the command `stiv`."""

    name: str
    arguments: tuple[str, ...]
    inputs: tuple[Path, ...]
    outputs: tuple[Path, ...]


@dataclass(frozen=True)
class Job:
    """All entries; `time_limit` in seconds for each, 0 for none."""

    entries: tuple[Entry, ...]
    time_limit: float = 0.0
    description: str = ""


def read_job(path: Path) -> Job:
    """The job in a file; paths in it are relative to its folder. Raises InputError naming file, entry and field."""
    data = read_json(path, MAX_BYTES)
    try:
        return parse_job(data, path.resolve().parent)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def parse_job(data: object, folder: Path) -> Job:
    """The job in parsed JSON. Raises InputError naming entry and field."""
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        raise InputError(f'not a job: the field "schema" is not "{SCHEMA}"')
    if data.get("version") != VERSION:
        raise InputError(f"version {data.get('version')!r} of the format is not known; this program reads {VERSION}")
    _refuse_unknown(data, {"schema", "version", "description", "time_limit", "entries"}, "the job")
    entries = data.get("entries")
    if not isinstance(entries, list):
        raise InputError('the field "entries" is not a list')
    parsed = tuple(_entry(entry, f"entry {number}", folder) for number, entry in enumerate(entries))
    _refuse_clashes(parsed)
    return Job(
        parsed, _seconds(data.get("time_limit", 0)), _text(data.get("description", ""), "description", "the job")
    )


def _entry(data: object, where: str, folder: Path) -> Entry:
    if not isinstance(data, dict):
        raise InputError(f"{where}: not an object with named fields")
    name = _text(data.get("name"), "name", where)
    if not name or len(name) > MAX_NAME or not name.isprintable():
        raise InputError(f'{where}: "name" must have 1 to {MAX_NAME} printable characters')
    where = f'{where} ("{name}")'
    task = data.get("do")
    if not isinstance(task, str) or task not in _FIELDS:
        raise InputError(f'{where}: "do" is {task!r}, none of {", ".join(_FIELDS)}')
    required, optional = _FIELDS[task]
    for field in sorted(required - set(data)):
        raise InputError(f'{where}: {task} needs the field "{field}"')
    _refuse_unknown(data, {"name", "do"} | required | optional, where)
    files = {f: folder / _path(data[f], f, where) for f in (*_FILES_IN, *_FILES_OUT) if f in data}
    return Entry(
        name,
        tuple(_arguments(task, data, files, where)),
        tuple(files[field] for field in _FILES_IN if field in files),
        tuple(files[field] for field in _FILES_OUT if field in files),
    )


def _arguments(task: str, data: Mapping[str, Any], files: Mapping[str, Path], where: str) -> list[str]:
    """What `stiv` is called with; values that begin with a dash stay values."""
    arguments = [task, str(files["scene"])]
    if "edits" in files:
        arguments.append(str(files["edits"]))
    if "output" in files:
        arguments.append(f"--output={files['output']}")
    if "report" in files:
        arguments.append(f"--{'json' if task == 'check' else 'report'}={files['report']}")
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
        raise InputError(f'{where}: unknown field "{unknown[0]}"; there are {", ".join(sorted(known))}')


def _refuse_clashes(entries: tuple[Entry, ...]) -> None:
    """No two entries of one name, and no file written twice or both read and written."""
    names: dict[str, int] = {}
    written: dict[Path, str] = {}
    for number, entry in enumerate(entries):
        if names.setdefault(entry.name, number) != number:
            raise InputError(f'entry {number}: the name "{entry.name}" is that of entry {names[entry.name]} too')
        for path in entry.outputs:
            if path in written:
                raise InputError(f'entry {number} ("{entry.name}"): {path} is written by "{written[path]}" too')
            written[path] = entry.name
    for number, entry in enumerate(entries):
        for path in entry.inputs:
            if path in written:
                raise InputError(
                    f'entry {number} ("{entry.name}"): {path} is read here and written by "{written[path]}"'
                )


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
        raise InputError(f'{where}: "{field}" is not a list of names of objects')
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
