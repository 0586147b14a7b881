# SPDX-License-Identifier: GPL-3.0-or-later
"""Run the named parts of the tests, all of them even when one fails, and print one summary at the end.

Usage: run_tests.py PART...   with the parts native, sanitizers, python, blender and lint.
"""

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import junit_counts
from junit_counts import Counts

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build"
REPORTS = BUILD / "test-reports"
TIME_LIMIT = 1800  # seconds for one part
LINT_CHECKS = ("cpp-format", "python-format", "python-style", "types")


def run(title: str, command: list[str | Path]) -> int:
    """Run one command from the root of the source tree, with its output shown as it comes; end it when it hangs."""
    print(f"\n== {title}", flush=True)
    try:
        return subprocess.run(command, cwd=ROOT, check=False, timeout=TIME_LIMIT).returncode
    except subprocess.TimeoutExpired:
        print(f"{title}: ended after {TIME_LIMIT} s", flush=True)
        return 1


def native(title: str, folder: str) -> Counts:
    """Native tests of one build folder."""
    report = REPORTS / f"{folder}.xml"
    report.unlink(missing_ok=True)
    command = ["ctest", "--test-dir", BUILD / folder, "--output-on-failure", "--output-junit", report]
    code = run(title, [*command, "--parallel", str(os.cpu_count()), "--test-output-size-passed", "65536"])
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
        counts.add(junit_counts.from_exit_code(run(f"{title}: {check}", ["tools/lint.sh", check])))
    return counts


def parts(name: str) -> Iterator[tuple[str, Counts]]:
    """Title and counts of each run that belongs to a part; runs it when asked for."""
    if name == "native":
        yield name, native(name, "native")
    elif name == "sanitizers":
        yield name, native(name, "asan")
    elif name == "python":
        yield name, pytest(name, BUILD / "venv", "-m", "not blender")
    elif name == "blender":
        for venv in sorted(BUILD.glob("venv-blender-*")):
            title = venv.name.removeprefix("venv-")
            yield title, pytest(title, venv, "-m", "blender")
    elif name == "lint":
        yield name, lint(name)
    else:
        raise SystemExit(f"run_tests.py: unknown part {name!r}")


def print_row(title: str, counts: Counts, seconds: float) -> None:
    """One line of the summary, and a line for each reason for which tests were skipped."""
    print(f"{title:<20}{counts.passed:>8}{counts.failed:>8}{counts.skipped.total():>9}{seconds:>9.0f}")
    for reason, number in sorted(counts.skipped.items()):
        print(f"    skipped {number}: {reason}")


def main(names: list[str]) -> int:
    """Run, summarise; 1 if anything failed."""
    REPORTS.mkdir(parents=True, exist_ok=True)
    rows: list[tuple[str, Counts, float]] = []
    for name in names:
        start = time.monotonic()
        for title, counts in parts(name):
            rows.append((title, counts, time.monotonic() - start))
            start = time.monotonic()
    total = Counts()
    print(f"\n{'part':<20}{'passed':>8}{'failed':>8}{'skipped':>9}{'seconds':>9}")
    for title, counts, seconds in rows:
        print_row(title, counts, seconds)
        total.add(counts)
    print(f"{total.passed} passed, {total.failed} failed", flush=True)
    return int(total.failed > 0)


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
