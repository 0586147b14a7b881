# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv batch`: many scenes, on worker processes or on a cluster."""

from __future__ import annotations

import argparse
import os
import re
import signal
import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from stiv import InputError
from stiv.batch.dask_cluster import require_distributed, run_on_cluster
from stiv.batch.job import Job, read_job
from stiv.batch.pool import Pool, PoolError
from stiv.batch.records import Record
from stiv.batch.run import RunOptions, exit_code, report_of, run_job
from stiv.command_line.installed_blender import blender_command
from stiv.command_line.progress import progress_bar
from stiv.exit_codes import ExitCode
from stiv.json_files import write_json
from stiv.output_files import require_folder, resolved

if TYPE_CHECKING:
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]

_DESCRIPTION = """\
Runs a job: a file that lists scenes, a command for each (check, replay, repair, resolve) and output files. Each output
is complete or absent. If a worker process dies, its scene is tried once more. docs/batch.md describes the format."""
_EXAMPLES = """\
examples:
  stiv batch job.json --workers 4
  stiv batch job.json --workers 4 --resume            continue where an earlier run ended
  stiv batch job.json --scheduler tcp://farm:8786     on a Dask cluster with access to the same files
  stiv batch job.json --part 3/8 --resume             the third of eight parts, for a render farm

exit codes: the worst of all scenes: 0 done, 4 intersections found, 2 bad input, 1 wrong usage, 3 a scene whose
worker died twice or another internal error, 5 cancelled"""


def add_to(subcommands: Subparsers) -> None:
    """Adds the subcommand to the parser."""
    parser = subcommands.add_parser(
        "batch",
        help="run a job over many scenes",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("job", type=Path, metavar="JOB.json", help="the job")
    where = parser.add_mutually_exclusive_group()
    where.add_argument("--workers", type=int, metavar="N", help="worker processes (default: one for each processor)")
    where.add_argument("--scheduler", metavar="ADDRESS", help="run on the Dask cluster with this scheduler")
    parser.add_argument("--resume", action="store_true", help="skip finished scenes with unchanged inputs")
    parser.add_argument("--part", metavar="K/N", type=_part, help="run every Nth entry, starting with the Kth")
    parser.add_argument(
        "--report", type=Path, metavar="F", help="write the result and cost of each scene to F, as JSON"
    )
    parser.add_argument(
        "--blender", dest="worker_blender", default="", metavar="PATH", help="workers use this installed Blender"
    )
    parser.set_defaults(run=_run)


def _run(arguments: argparse.Namespace) -> ExitCode:
    require_folder(arguments.report)
    if arguments.workers is not None and not 1 <= arguments.workers <= 1024:
        raise InputError(f"--workers: {arguments.workers} is not between 1 and 1024")
    whole = read_job(arguments.job)
    job = whole if arguments.part is None else _part_of(whole, *arguments.part)
    state = resolved(arguments.job).with_suffix(".state")
    part = "" if arguments.part is None else "-{}-of-{}".format(*arguments.part)
    options = RunOptions(state, arguments.resume, arguments.worker_blender, f"lock{part}")
    for name in {"SIGTERM", "SIGBREAK"} & set(dir(signal)):  # the second: Ctrl+Break on Windows
        signal.signal(signal.Signals[name], _cancel)
    begin = time.perf_counter()
    with progress_bar("scenes", len(job.entries)) as advance:
        try:
            records = run_job(job, options, _runner(arguments, job, state), lambda record: advance(record.name))
        except PoolError as error:
            raise InputError(str(error)) from error
    seconds = time.perf_counter() - begin
    if arguments.report is not None:
        write_json(arguments.report, report_of(job, records, seconds))
    print(summary(records, seconds))
    return exit_code(records)


def summary(records: Sequence[Record], seconds: float) -> str:
    """Result and cost of each scene, one per line, and a total."""
    lines = [_line(record) for record in records]
    done = sum(record.finished for record in records)
    skipped = sum(record.skipped for record in records)
    total = f"{done} of {len(records)} scenes done ({skipped} by an earlier run), {seconds:.1f} s"
    return "\n".join([*lines, total])


def _line(record: Record) -> str:
    result = {0: "done", 4: "not free", 2: "bad input", None: "lost"}.get(
        record.exit_code, f"exit code {record.exit_code}"
    )
    retried = f", attempt {record.attempts}" if record.attempts > 1 else ""
    message = headline(record.message, record.exit_code) if record.exit_code != 0 else ""
    how = "before" if record.skipped else f"{record.seconds:.1f} s, {record.peak_megabytes:.0f} MB{retried}"
    return f"{record.name}: {result} ({how})" + (f": {message}" if message else "")


def headline(message: str, code: int | None) -> str:
    """The most informative line of a command's output: the first of a result, the last of an error."""
    lines = message.splitlines() or [""]
    return lines[0 if code == ExitCode.NOT_FREE else -1]


def _runner(arguments: argparse.Namespace, job: Job, state: Path) -> Callable[..., None]:
    if arguments.scheduler is None:
        processors = _processors()
        size = arguments.workers or processors
        log = state / "workers.log"
        command = worker_command(arguments.worker_blender)
        pool = Pool(size, command, job.time_limit, log, threads=max(1, processors // size))
        return pool.run
    require_distributed()

    def on_cluster(
        names: Sequence[str], commands: Sequence[Sequence[str]], on_done: Callable[[int, Record], None]
    ) -> None:
        start = partial(worker_command, arguments.worker_blender)
        run_on_cluster(arguments.scheduler, names, commands, on_done, start, job.time_limit)

    return on_cluster


def worker_command(blender: str) -> list[str]:
    """The command that starts a worker: with this Python, or inside an installed Blender. Raises InputError."""
    return blender_command(blender, ["worker"]) if blender else [sys.executable, "-m", "stiv.command_line", "worker"]


def _processors() -> int:
    """Number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _part(text: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d{1,6})/(\d{1,6})", text)
    if match is None or not 1 <= int(match[1]) <= int(match[2]):
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form K/N with K from 1 to N")
    return int(match[1]), int(match[2])


def _part_of(job: Job, part: int, parts: int) -> Job:
    return Job(job.entries[part - 1 :: parts], job.time_limit, job.description)


def _cancel(number: int, frame: Any) -> NoReturn:
    raise KeyboardInterrupt
