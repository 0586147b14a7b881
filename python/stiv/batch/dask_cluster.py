# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs entries on a Dask cluster (`distributed`, from the extra `cluster`) whose workers see the same files.

Each thread of a Dask worker has a worker process with one Blender, so that a crash of Blender does not end the Dask
worker. Dask repeats the entries of a lost machine. A Dask thread stands for one processor: its worker process edits
with one thread, or with STIV_THREADS of the environment of the Dask worker.
"""

from __future__ import annotations

import importlib.util
import threading
from collections.abc import Callable, Sequence
from typing import Any

from stiv import InputError
from stiv.batch.pool import Pool
from stiv.batch.records import Record, as_json

CONNECT_LIMIT = 30  # seconds

_of_thread = threading.local()


def require_distributed() -> None:
    """Raises InputError if Dask is not installed."""
    if importlib.util.find_spec("distributed") is None:
        raise InputError("--scheduler needs Dask, which is not installed: `pip install stiv[cluster]`")


def run_on_cluster(
    address: str,
    names: Sequence[str],
    commands: Sequence[Sequence[str]],
    on_done: Callable[[int, Record], None],
    worker_command: Callable[[], Sequence[str]],
    time_limit: float = 0.0,
) -> None:
    """Runs every command on the cluster whose scheduler is at `address`; otherwise as Pool.run.

    worker_command: called on the cluster, gives the command that starts a worker there.
    """
    from distributed import Client, as_completed

    try:
        client = Client(address, timeout=CONNECT_LIMIT)
    except (OSError, ValueError) as error:
        raise InputError(f"--scheduler: {address} does not answer: {error}") from error
    with client:
        futures = {
            client.submit(run_entry, name, list(command), worker_command, time_limit, pure=False): number
            for number, (name, command) in enumerate(zip(names, commands, strict=True))
        }
        for future in as_completed(futures):
            number = futures[future]
            if future.status == "finished":
                on_done(number, Record(**future.result()))
            else:
                on_done(number, Record(names[number], None, f"lost by the cluster: {future.exception()}"))


def run_entry(
    name: str, command: list[str], worker_command: Callable[[], Sequence[str]], time_limit: float
) -> dict[str, Any]:
    """Runs one entry on a worker of the cluster; its record."""
    found: list[Record] = []
    pool = _pool(tuple(worker_command()), time_limit)
    pool.run([name], [command], lambda number, record: found.append(record), keep=True)
    return as_json(found[0])


def _pool(worker_command: tuple[str, ...], time_limit: float) -> Pool:
    """The pool with one process that belongs to this thread."""
    pools: dict[tuple[tuple[str, ...], float], Pool] = _of_thread.__dict__.setdefault("pools", {})
    return pools.setdefault((worker_command, time_limit), Pool(1, worker_command, time_limit))
