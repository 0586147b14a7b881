# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps what Blender prints about files and operators off the terminal."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def quiet_blender(*, errors: bool = False) -> Iterator[None]:
    """Within, nothing reaches standard output: Blender writes there beneath Python. Progress bars still show.

    With `errors` nothing reaches standard error either: renders complain there of displays that they do not need.
    """
    sys.stdout.flush()
    streams = (1, 2) if errors else (1,)
    kept = [os.dup(stream) for stream in streams]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream in streams:
            os.dup2(nowhere, stream)
        yield
    finally:
        for stream, copy in zip(streams, kept, strict=True):
            os.dup2(copy, stream)
            os.close(copy)
        os.close(nowhere)
