# SPDX-License-Identifier: GPL-3.0-or-later
"""Output files that are whole or not there: written beside their place under another name, then renamed."""

from __future__ import annotations

import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from stiv import InputError
from stiv.command_line.json_text import json_text


@contextmanager
def written_atomically(path: Path) -> Iterator[Path]:
    """Gives a path of the same folder and suffix to write to; left without an error, it takes the place of `path`.

    Raises InputError if the file cannot be written there; what was at `path` then stays.
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
    """Raises InputError if the folder that `path` shall be written to is not there: before any work is done."""
    if path is not None and not path.parent.is_dir():
        raise InputError(f"{path}: there is no folder {path.parent} to write to")


def write_json(path: Path, data: dict[str, Any]) -> None:
    """Writes `data` as indented JSON."""
    with written_atomically(path) as temporary:
        temporary.write_text(json_text(data) + "\n", encoding="utf-8")
