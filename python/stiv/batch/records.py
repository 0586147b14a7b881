# SPDX-License-Identifier: GPL-3.0-or-later
"""What is known of finished entries: one small file each, written after the entry's outputs are in place."""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import quote

import stiv._native
from stiv import InputError
from stiv.batch.job import Entry
from stiv.exit_codes import ExitCode
from stiv.json_files import read_json, write_json

SCHEMA, VERSION = "stiv-batch-record", 1
MAX_BYTES = 16 * 2**20
FINISHED = (ExitCode.DONE, ExitCode.NOT_FREE)


@dataclass(frozen=True)
class Record:
    """What an entry came to: the exit code of its command (None: its worker died), and what that took."""

    name: str
    code: int | None
    message: str = ""  #: what the command said: the first line and, of a long text, the last ones
    seconds: float = 0.0
    attempts: int = 1
    peak_megabytes: float = 0.0  #: of the worker, up to the end of this entry
    skipped: bool = False  #: finished by an earlier run
    fingerprint: str = ""
    outputs: dict[str, str] = field(default_factory=dict)  #: path and SHA-256

    @property
    def finished(self) -> bool:
        """Need it not be run again while its inputs stay the same?"""
        return self.code in FINISHED


def program_version(blender: str = "") -> str:
    """What results depend on besides the inputs: STIV's version and core, and which Blender runs it."""
    versions = [_version("stiv"), file_hash(Path(str(stiv._native.__file__))), _version("bpy"), blender]
    return "/".join(versions)


def fingerprint(entry: Entry, version: str) -> str:
    """A hash of the entry's arguments, the contents of its inputs, and the program's version. Raises InputError."""
    parts = [version, *entry.arguments]
    parts += [_input_hash(path) for path in entry.inputs]
    return hashlib.sha256("\0".join(parts).encode("utf-8", "surrogatepass")).hexdigest()


def with_outputs(record: Record, entry: Entry) -> Record:
    """The record with the hashes of the outputs that are there."""
    outputs = {str(path): file_hash(path) for path in entry.outputs if path.is_file()}
    return Record(**{**asdict(record), "outputs": outputs})


def write_record(folder: Path, record: Record) -> None:
    """Puts the record into the folder of records, whole or not at all."""
    write_json(_place(folder, record.name), {"schema": SCHEMA, "version": VERSION, **asdict(record)})


def finished_record(folder: Path, entry: Entry, wanted: str) -> Record | None:
    """The record of an entry that is finished with this fingerprint and whose outputs are still those it wrote."""
    try:
        data = read_json(_place(folder, entry.name), MAX_BYTES)
        if (data.pop("schema"), data.pop("version")) != (SCHEMA, VERSION):
            return None
        record = Record(**data)
        intact = all(file_hash(Path(path)) == digest for path, digest in record.outputs.items())
    except (InputError, OSError, KeyError, TypeError, AttributeError):  # none, or not ours: the entry is run again
        return None
    return record if intact and record.finished and record.fingerprint == wanted else None


def remove_record(folder: Path, name: str) -> None:
    """Forgets an entry."""
    _place(folder, name).unlink(missing_ok=True)


def file_hash(path: Path) -> str:
    """SHA-256 of a file's contents. Raises OSError."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def _input_hash(path: Path) -> str:
    try:
        return file_hash(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from error


def _version(package: str) -> str:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "none"


def _place(folder: Path, name: str) -> Path:
    return folder / f"{quote(name, safe=' ')}.json"


def as_json(record: Record) -> dict[str, Any]:
    """The record as the report of a job lists it."""
    data: dict[str, Any] = json.loads(json.dumps(asdict(record)))
    return data
