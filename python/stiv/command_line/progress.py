# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress bars (rich, from the extra `cli`), if rich is installed and the output is a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def progress_bar(title: str, total: int) -> Iterator[Callable[..., None]]:
    """Yields a function `advance(note, steps=1)` that advances the bar and shows a note."""
    try:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
    except ImportError:
        yield lambda note, steps=1: None
        return
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    console = Console(stderr=True)
    note = TextColumn("{task.fields[note]}")
    with Progress(*columns, note, console=console, disable=not console.is_terminal) as progress:
        task = progress.add_task(title, total=total, note="")
        yield lambda note, steps=1: progress.update(task, advance=steps, note=note)


@contextmanager
def fraction_bar(title: str) -> Iterator[Callable[[str, float], None]]:
    """Yields a function that shows a phase and its progress in [0, 1]."""
    try:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
    except ImportError:
        yield lambda phase, fraction: None
        return
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TextColumn("{task.fields[note]}"))
    console = Console(stderr=True)
    with Progress(*columns, console=console, disable=not console.is_terminal) as progress:
        task = progress.add_task(title, total=1.0, note="")
        yield lambda phase, fraction: progress.update(task, completed=fraction, note=phase)
