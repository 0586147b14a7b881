# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of entries: a small file for each, written after the outputs of the entry."""

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

SCHEMA, VERSION = "stiv-batch-record", 2
MAX_BYTES = 16 * 2**20
FINISHED = (ExitCode.DONE, ExitCode.NOT_FREE)


@dataclass(frozen=True)
class Record:
    """The result of an entry: the exit code of its command (None: its worker died), and its cost."""

    name: str
    exit_code: int | None
    message: str = ""  #: output of the command; of a long text, the first line and the end
    seconds: float = 0.0
    attempts: int = 1
    peak_megabytes: float = 0.0  #: memory of the worker, up to the end of this entry
    skipped: bool = False  #: finished by an earlier run
    fingerprint: str = ""
    outputs: dict[str, str] = field(default_factory=dict)  #: path and SHA-256

    @property
    def finished(self) -> bool:
        """Whether the result stays valid while the inputs stay the same."""
        return self.exit_code in FINISHED


def program_version(blender: str = "") -> str:
    """The version of STIV, its core, and the Blender used, on which results depend."""
    versions = [_version("stiv"), file_hash(Path(str(stiv._native.__file__))), _version("bpy"), blender]
    return "/".join(versions)


def fingerprint(entry: Entry, version: str) -> str:
    """A hash of the entry's arguments, its inputs and the version of the program. Raises InputError."""
    parts = [version, *entry.arguments]
    parts += [_input_hash(path) for path in entry.inputs]
    return hashlib.sha256("\0".join(parts).encode("utf-8", "surrogatepass")).hexdigest()


def with_outputs(record: Record, entry: Entry) -> Record:
    """The record with the hashes of the outputs that exist."""
    outputs = {str(path): file_hash(path) for path in entry.outputs if path.is_file()}
    return Record(**{**asdict(record), "outputs": outputs})


def write_record(folder: Path, record: Record) -> None:
    """Writes the record to the folder of records."""
    write_json(_place(folder, record.name), {"schema": SCHEMA, "version": VERSION, **asdict(record)})


def finished_record(folder: Path, entry: Entry, wanted: str) -> Record | None:
    """The record of an entry that finished with this fingerprint and whose outputs are unchanged, or None."""
    try:
        data = read_json(_place(folder, entry.name), MAX_BYTES)
        if (data.pop("schema"), data.pop("version")) != (SCHEMA, VERSION):
            return None
        record = Record(**data)
        intact = all(file_hash(Path(path)) == digest for path, digest in record.outputs.items())
    except (InputError, OSError, KeyError, TypeError, AttributeError):  # missing or invalid: the entry runs again
        return None
    return record if intact and record.finished and record.fingerprint == wanted else None


def remove_record(folder: Path, name: str) -> None:
    """Removes the record of an entry."""
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
    """The record as an entry of the report."""
    data: dict[str, Any] = json.loads(json.dumps(asdict(record)))
    return data
