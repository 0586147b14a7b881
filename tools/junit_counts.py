# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of a test run, counted from the JUnit files of pytest and ctest."""

import ast
import re
import xml.etree.ElementTree as ElementTree
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

DOCTEST_SUMMARY = re.compile(r"test cases:\s*\d+ \|\s*(\d+) passed \|\s*(\d+) failed")


@dataclass
class Counts:
    """Numbers of tests, how many were skipped for each reason, and a line for each failure that has a name."""

    passed: int = 0
    failed: int = 0
    skipped: Counter[str] = field(default_factory=Counter)
    failures: list[str] = field(default_factory=list)

    def add(self, other: "Counts") -> None:
        """Add the numbers of another run."""
        self.passed += other.passed
        self.failed += other.failed
        self.skipped.update(other.skipped)
        self.failures += other.failures


def from_exit_code(name: str, code: int) -> Counts:
    """One test that passes if the exit code of a process is 0."""
    return Counts(passed=int(code == 0), failed=int(code != 0), failures=[name] if code != 0 else [])


def from_pytest(path: Path, code: int) -> Counts:
    """Counts of pytest's JUnit file; a failed run without a failed test counts as one failure."""
    counts = Counts()
    for case in _cases(path):
        skip = case.find("skipped")
        failure = next(case.iterfind("failure"), case.find("error"))
        if skip is not None:
            counts.skipped[_reason(skip)] += 1
        elif failure is not None:
            counts.failed += 1
            counts.failures.append(_failure(case, failure))
        else:
            counts.passed += 1
    nothing_collected = 5
    if code not in (0, nothing_collected):
        counts.failed = max(counts.failed, 1)
    return counts


def from_ctest(path: Path, code: int) -> Counts:
    """Test cases that doctest reports in the output stored by ctest; a process without a report is one failure."""
    counts = Counts()
    for case in _cases(path):
        summary = DOCTEST_SUMMARY.search(case.findtext("system-out", ""))
        passed, failed = (int(summary[1]), int(summary[2])) if summary else (0, 1)
        counts.add(Counts(passed, failed, failures=[str(case.get("name"))] if failed else []))
    if code != 0:
        counts.failed = max(counts.failed, 1)
    return counts


def from_doctest(output: str, code: int) -> Counts:
    """Test cases of a program's output; a line "skipped: reason" instead is one skip."""
    summaries = [Counts(int(found[1]), int(found[2])) for found in DOCTEST_SUMMARY.finditer(output)]
    skipped = re.search(r"^skipped: (.*)$", output, re.MULTILINE)
    counts = Counts(skipped=Counter([skipped[1]] if skipped else []))
    for summary in summaries:
        counts.add(summary)
    if code != 0 or not (summaries or skipped):
        counts.failed = max(counts.failed, 1)
    return counts


def _failure(case: ElementTree.Element, failure: ElementTree.Element) -> str:
    """Name and first line of the message."""
    message = failure.get("message", "").strip().splitlines() or ["no message"]
    return f"{case.get('classname')}.{case.get('name')}: {message[0][:200]}"


def _reason(skip: ElementTree.Element) -> str:
    """The reason for a skip; for a whole module, pytest writes it into the text, after the location."""
    if skip.get("message") == "collection skipped" and skip.text:
        return ast.literal_eval(skip.text)[-1].removeprefix("Skipped: ")
    return skip.get("message", "no reason given")


def _cases(path: Path) -> list[ElementTree.Element]:
    return list(ElementTree.parse(path).iter("testcase")) if path.exists() else []
