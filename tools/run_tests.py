# SPDX-License-Identifier: GPL-3.0-or-later
"""Run the named parts of the tests, even if one of them fails, and print a summary at the end.

Usage: run_tests.py PART...   with the parts native, sanitizers, threads, windows, python, blender, lint and
window. They begin in the given order: with the longest ones first, all processors are busy to the end.
"""

import os
import re
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import junit_counts
from junit_counts import Counts

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build"
REPORTS = BUILD / "test-reports"
TIME_LIMIT = 3600  # seconds for one command: a last resort, several times the longest duration
WINDOW_SEQUENCES = 12  # random events per sequence run; `make test-window` plays more
LINT_CHECKS = ("cpp-format", "cpp-checks", "python-format", "python-style", "types", "spelling", "documents")
PRINTING = threading.Lock()


@dataclass(frozen=True)
class Job:
    """One run of tests. Jobs that use all processors run alone."""

    title: str
    run: Callable[[], Counts]
    alone: bool = False


@dataclass(frozen=True)
class Row:
    """The result of a job."""

    title: str
    counts: Counts
    seconds: float


def log_of(title: str) -> Path:
    """Where the output of a run is stored."""
    return REPORTS / f"{re.sub('[^a-z0-9.-]+', '-', title)}.log"


def run(title: str, command: list[str | Path]) -> int:
    """Run a command from the root of the source tree, and print its output when it ends. Ends commands that hang."""
    log = log_of(title)
    with log.open("wb") as output:
        try:
            code = subprocess.run(
                command, cwd=ROOT, check=False, timeout=TIME_LIMIT, stdout=output, stderr=subprocess.STDOUT
            ).returncode
        except subprocess.TimeoutExpired:
            output.write(f"{title}: ended after {TIME_LIMIT} s\n".encode())
            code = 1
    with PRINTING:
        print(f"\n== {title}\n{log.read_text(errors='replace')}", flush=True)
    return code


def native(title: str, folder: str, *arguments: str) -> Counts:
    """Native tests of one build folder; `arguments` for ctest."""
    report = REPORTS / f"{title}.xml"
    report.unlink(missing_ok=True)
    command = ["ctest", "--test-dir", BUILD / folder, "--output-on-failure", "--output-junit", report]
    code = run(title, [*command, "--parallel", str(os.cpu_count()), "--test-output-size-passed", "65536", *arguments])
    return junit_counts.from_ctest(report, code)


def pytest(title: str, venv: Path, *arguments: str) -> Counts:
    """Python tests in one virtual environment."""
    report = REPORTS / f"{venv.name}.xml"
    report.unlink(missing_ok=True)
    command = [venv / "bin/python", "-m", "pytest", "-q", "-p", "no:cacheprovider", f"--junitxml={report}"]
    code = run(title, [*command, *arguments])
    return junit_counts.from_pytest(report, code)


def lint(title: str) -> Counts:
    """Checks of format, style and types; each counts as one test."""
    counts = Counts()
    for check in LINT_CHECKS:
        counts.add(junit_counts.from_exit_code(check, run(f"{title}: {check}", ["tools/lint.sh", check])))
    return counts


def windows(title: str) -> Counts:
    """Exact signs on Windows: a program compiled by Zig, under Wine; skipped with the reason without them."""
    code = run(title, ["tools/test_windows.sh", sys.executable, BUILD / "opensubdiv", "--predicates"])
    return junit_counts.from_doctest(log_of(title).read_text(errors="replace"), code)


def window(title: str) -> Counts:
    """The add-on in a real window; skipped with the reason if no chroot can be created."""
    report = REPORTS / "window.xml"
    report.unlink(missing_ok=True)
    command = [sys.executable, "tests/window/run.py", "--report", report, "--sequences", str(WINDOW_SEQUENCES)]
    return junit_counts.from_pytest(report, run(title, command))


def jobs(name: str) -> Iterator[Job]:
    """The runs that belong to a part."""
    if name == "native":
        yield Job(name, lambda: native(name, "native", "--exclude-regex", "^sanitized_"), alone=True)
    elif name == "sanitizers":
        yield Job(name, lambda: native(name, "native", "--tests-regex", "^sanitized_"), alone=True)
    elif name == "threads":
        yield Job(name, lambda: native(name, "tsan", "--tests-regex", "^threads$"))
    elif name == "windows":
        yield Job(name, lambda: windows(name))
    elif name == "python":
        yield Job(name, lambda: pytest(name, BUILD / "venv", "-m", "not blender"))
    elif name == "blender":
        for venv in sorted(BUILD.glob("venv-blender-*")):
            title = venv.name.removeprefix("venv-")
            yield Job(title, partial(pytest, title, venv, "-m", "blender"))
    elif name == "lint":
        yield Job(name, lambda: lint(name))
    elif name == "window":
        yield Job(name, lambda: window(name))
    else:
        raise SystemExit(f"run_tests.py: unknown part {name!r}")


def timed(job: Job) -> Row:
    """Run one job."""
    print(f"-- {job.title}: begun", flush=True)
    start = time.monotonic()
    return Row(job.title, job.run(), time.monotonic() - start)


def run_all(todo: list[Job]) -> list[Row]:
    """Run the jobs that need the whole machine one by one, then the others in parallel."""
    rows = [timed(job) for job in todo if job.alone]
    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        rows += pool.map(timed, [job for job in todo if not job.alone])
    return rows


def print_row(row: Row) -> None:
    """One line of the summary, and a line for each failure and each reason for skipped tests."""
    counts = row.counts
    print(f"{row.title:<20}{counts.passed:>8}{counts.failed:>8}{counts.skipped.total():>9}{row.seconds:>9.0f}")
    for failure in counts.failures:
        print(f"    failed {failure}")
    for reason, number in sorted(counts.skipped.items()):
        print(f"    skipped {number}: {reason}")


def main(names: list[str]) -> int:
    """Run, summarise; 1 if anything failed."""
    REPORTS.mkdir(parents=True, exist_ok=True)
    rows = run_all([job for name in names for job in jobs(name)])
    total = Counts()
    print(f"\n{'part':<20}{'passed':>8}{'failed':>8}{'skipped':>9}{'seconds':>9}")
    for row in rows:
        print_row(row)
        total.add(row.counts)
    print(f"{total.passed} passed, {total.failed} failed", flush=True)
    return int(total.failed > 0)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
