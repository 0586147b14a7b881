# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs a job: skips finished entries on request, runs the others on workers, and records every result."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TextIO

from stiv import InputError
from stiv.batch.job import Entry, Job
from stiv.batch.records import (
    Record,
    as_json,
    fingerprint,
    finished_record,
    program_version,
    remove_record,
    with_outputs,
    write_record,
)
from stiv.exit_codes import ExitCode

SCHEMA, VERSION = "stiv-batch-report", 2

# Runs named commands. The callback receives the index and the record of each command as it finishes.
Runner = Callable[[Sequence[str], Sequence[Sequence[str]], Callable[[int, Record], None]], None]


@dataclass(frozen=True)
class RunOptions:
    """How a job runs."""

    state: Path  #: folder of the records
    resume: bool = False
    blender: str = ""
    lock: str = "lock"  #: name of the lock file; concurrent parts of a job need different names


def run_job(
    job: Job, options: RunOptions, runner: Runner, on_entry: Callable[[Record], None] = lambda record: None
) -> list[Record]:
    """Runs a job and returns a record for each entry, in the order of the job. Calls `on_entry` with each record."""
    with _locked(options.state, options.lock):
        _remove_leftovers(job)
        records: dict[str, Record] = {}
        waiting: list[tuple[Entry, str]] = []
        version = program_version(options.blender)

        def note(record: Record) -> None:
            records[record.name] = record
            on_entry(record)

        for entry in job.entries:
            done = _known_result(entry, version, options)
            if isinstance(done, Record):
                note(done)
            else:
                remove_record(options.state, entry.name)
                waiting.append((entry, done))

        def finish(number: int, record: Record) -> None:
            entry, mark = waiting[number]
            written = replace(with_outputs(record, entry), fingerprint=mark)
            write_record(options.state, written)
            note(written)

        _make_folders(entry for entry, _ in waiting)
        runner([entry.name for entry, _ in waiting], [entry.arguments for entry, _ in waiting], finish)
        return [records[entry.name] for entry in job.entries]


def report_of(job: Job, records: Sequence[Record], seconds: float) -> dict[str, Any]:
    """The report, as JSON data."""
    return {
        "schema": SCHEMA,
        "version": VERSION,
        "description": job.description,
        "seconds": round(seconds, 3),
        "entries": [as_json(record) for record in records],
    }


def exit_code(records: Sequence[Record]) -> ExitCode:
    """The worst exit code of all entries."""
    codes = {ExitCode.INTERNAL_ERROR if record.exit_code is None else ExitCode(record.exit_code) for record in records}
    order = (ExitCode.CANCELLED, ExitCode.INTERNAL_ERROR, ExitCode.USAGE, ExitCode.BAD_INPUT, ExitCode.NOT_FREE)
    return next((code for code in order if code in codes), ExitCode.DONE)


def _known_result(entry: Entry, version: str, options: RunOptions) -> Record | str:
    """The record of an entry that need not or cannot run, otherwise its fingerprint."""
    try:
        mark = fingerprint(entry, version)
    except InputError as error:
        return Record(entry.name, ExitCode.BAD_INPUT, str(error), attempts=0)
    done = finished_record(options.state, entry, mark) if options.resume else None
    return mark if done is None else replace(done, skipped=True)


def _make_folders(entries: Iterator[Entry]) -> None:
    for entry in entries:
        for path in entry.outputs:
            try:
                path.parent.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise InputError(f"{path.parent}: cannot be created: {error.strerror or error}") from error


def _remove_leftovers(job: Job) -> None:
    """Deletes the temporary files of killed runs, which are next to the outputs."""
    for folder in {path.parent for entry in job.entries for path in entry.outputs}:
        names = {(path.stem, path.suffix) for entry in job.entries for path in entry.outputs if path.parent == folder}
        for found in folder.glob(".*") if folder.is_dir() else ():
            match = re.fullmatch(r"\.(.*)-[0-9a-f]{8}(\.\w+)@?", found.name)
            if match and (match[1], match[2]) in names:
                found.unlink(missing_ok=True)


@contextmanager
def _locked(state: Path, name: str) -> Iterator[None]:
    """Creates the folder and locks it for this process. The lock ends with the process."""
    try:
        state.mkdir(parents=True, exist_ok=True)
        lock = (state / name).open("w")
    except OSError as error:
        raise InputError(f"{state}: cannot be written: {error.strerror or error}") from error
    with lock:
        try:
            _lock_file(lock)
        except OSError as error:
            raise InputError(f"{state}: another process is running this job") from error
        yield


def _lock_file(file: TextIO) -> None:
    """Locks a file for this process. Raises OSError if another process holds the lock."""
    if sys.platform == "win32":
        import msvcrt

        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
