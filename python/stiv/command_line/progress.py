# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress bars on the terminal (rich, from the extra `cli`); none where rich is missing or output is no terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def progress_bar(title: str, total: int) -> Iterator[Callable[..., None]]:
    """Gives a function `advance(note, steps=1)` that advances the bar and shows a note beside it."""
    try:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
    except ImportError:
        yield lambda note, steps=1: None
        return
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Progress(*columns, TextColumn("{task.fields[note]}"), console=Console(stderr=True)) as progress:
        task = progress.add_task(title, total=total, note="")
        yield lambda note, steps=1: progress.update(task, advance=steps, note=note)
