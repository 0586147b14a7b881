# SPDX-License-Identifier: GPL-3.0-or-later
"""Output files that are complete or absent: written under a temporary name in the same folder, then renamed."""

from __future__ import annotations

import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from stiv import InputError


@contextmanager
def written_atomically(path: Path) -> Iterator[Path]:
    """Yields a temporary path with the same folder and suffix, which replaces `path` if no error occurs.

    Raises InputError if the file cannot be written. An existing file then stays.
    """
    temporary = path.with_name(f".{path.stem}-{uuid.uuid4().hex[:8]}{path.suffix}")
    try:
        yield temporary
        with temporary.open("rb+") as written:
            os.fsync(written.fileno())
        os.replace(temporary, path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)


def require_folder(path: Path | None) -> None:
    """Raises InputError if the folder of an output does not exist. Called before any work is done."""
    if path is not None and not path.parent.is_dir():
        raise InputError(f"{path}: there is no folder {path.parent}; create it first")


def resolved(path: Path) -> Path:
    """The absolute path behind links, or the path as given where Windows cannot follow it."""
    try:
        return path.resolve()
    except OSError:
        return path.absolute()
