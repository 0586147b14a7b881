# SPDX-License-Identifier: GPL-3.0-or-later
"""Speedup of a job on a local Dask cluster with two workers compared with one.

    python tests/long/cluster_throughput.py [--scenes 40] [--repeats 3]

Prints scenes per second of wall time, processor seconds per scene (over all worker processes), and the ratio.
The exit code is 1 if the results differ, or if the median ratio is below 1.7. Two workers need two idle
processors; on a busy machine, they only take time from other programs. Needs /proc.
"""

import argparse
import os
import sys
import tempfile
import time
from contextlib import redirect_stdout, suppress
from glob import glob
from io import StringIO
from pathlib import Path
from statistics import median

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS.parent), str(TESTS / "batch")]

from distributed import LocalCluster  # noqa: E402
from jobs import results, write_job  # noqa: E402

from stiv.command_line import program  # noqa: E402

WANTED = 1.7


def children(parent: int) -> list[int]:
    """All descendants of a process; processes and threads may end during the search."""
    found = []
    for task in glob(f"/proc/{parent}/task/*/children"):
        with suppress(OSError):
            for child in map(int, Path(task).read_text().split()):
                found += [child, *children(child)]
    return found


def processor_seconds() -> float:
    """User and system time of all living descendants of this process."""
    ticks = 0
    for pid in children(os.getpid()):
        with suppress(OSError):
            fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
            ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def run(job: Path, scheduler: str) -> tuple[float, float]:
    """Wall and processor seconds for a job on a cluster."""
    begin, used = time.perf_counter(), processor_seconds()
    with redirect_stdout(StringIO()):
        code = program.run(["batch", str(job), "--scheduler", scheduler])
    if code != 0:
        raise SystemExit(f"the job ended with {code}")
    return time.perf_counter() - begin, processor_seconds() - used


def cluster(workers: int) -> LocalCluster:
    """A cluster of single-threaded processes."""
    return LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None)


def main() -> int:
    """Measure both clusters alternately."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scenes", type=int, default=40)
    parser.add_argument("--repeats", type=int, default=3)
    chosen = parser.parse_args()
    ratios = []
    with tempfile.TemporaryDirectory() as folder, cluster(1) as single, cluster(2) as double:
        places = {1: Path(folder, "one"), 2: Path(folder, "two")}
        clusters = {1: single, 2: double}
        for workers, place in places.items():
            place.mkdir()
            write_job(place, chosen.scenes, repeat=10)
            run(place / "job ü.json", clusters[workers].scheduler_address)  # starts the worker processes
        for _ in range(chosen.repeats):
            took = {}
            for workers, place in places.items():
                took[workers], used = run(place / "job ü.json", clusters[workers].scheduler_address)
                rate = chosen.scenes / took[workers]
                print(
                    f"{workers} worker(s): {rate:.2f} scenes a second, {used / chosen.scenes:.3f} s of processors each"
                )
            ratios.append(took[1] / took[2])
        same = results(places[1]) == results(places[2])
    print(f"throughput of two workers: {', '.join(f'{ratio:.2f}' for ratio in ratios)} times that of one")
    print("the results are the same" if same else "THE RESULTS DIFFER")
    return int(not same or median(ratios) < WANTED)


if __name__ == "__main__":
    raise SystemExit(main())
