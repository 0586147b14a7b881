# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks files in a process of its own, so that a crash of Blender costs one file, and not the report on all."""

from __future__ import annotations

import multiprocessing
import signal
import traceback
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path

from stiv import InputError
from stiv.checks.findings import FileCheck
from stiv.command_line.file_checking import CheckOptions, check_path


class CheckProcess:
    """A process that checks one file after the other; a new one follows if Blender crashes. Use `close` at the end."""

    def __init__(self) -> None:
        self._context = multiprocessing.get_context("spawn")  # a fork would share the threads of the core
        self._process: multiprocessing.process.BaseProcess | None = None

    @property
    def pid(self) -> int | None:
        """The id of the process; None if none runs."""
        return None if self._process is None else self._process.pid

    def check(self, path: Path, options: CheckOptions, on_look: Callable[[str], None]) -> FileCheck:
        """As `check_path`. Raises InputError if the file cannot be checked, or if Blender crashes."""
        try:
            if self._process is None:
                self._start()
            self._pipe.send((path, options))
            while True:
                found = self._pipe.recv()
                if isinstance(found, FileCheck):
                    return found
                kind, text = found
                if kind != "look":
                    raise InputError(text) if kind == "refused" else RuntimeError(text)
                on_look(text)
        except (EOFError, OSError) as end:
            self.close()
            raise InputError(
                f"{path}: Blender crashed on this file; save it again in the Blender that made it"
            ) from end

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._pipe.close()
        self._process = None

    def _start(self) -> None:
        self._pipe, other = self._context.Pipe()
        self._process = self._context.Process(target=_serve, args=(other,), daemon=True)
        self._process.start()
        other.close()


def _serve(pipe: Connection) -> None:
    """Check the files that arrive, until the other end is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the owner ends this process
    with suppress(EOFError, OSError):
        while True:
            path, options = pipe.recv()
            try:
                pipe.send(check_path(path, options, lambda note: pipe.send(("look", note))))
            except InputError as error:
                pipe.send(("refused", str(error)))
            except Exception:
                pipe.send(("failed", traceback.format_exc()))
