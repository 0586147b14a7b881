# SPDX-License-Identifier: GPL-3.0-or-later
"""A process of its own checks files, and its end costs one file only."""

import multiprocessing
import os
import signal
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from stiv import InputError
from stiv.command_line.file_checking import CheckOptions, check_path
from stiv.command_line.separate_checks import CheckProcess

CROSSED = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv 0 0 -1\nv 0 0 1\nv 0 2 0\nf 1 2 3\nf 4 5 6\n"


@pytest.fixture
def checks() -> Iterator[CheckProcess]:
    process = CheckProcess()
    yield process
    process.close()
    assert multiprocessing.active_children() == []


@pytest.fixture
def path(tmp_path: Path) -> Path:
    file = tmp_path / "crossed.obj"
    file.write_text(CROSSED, encoding="utf-8")
    return file


def test_results_are_those_of_a_check_in_this_process(checks: CheckProcess, path: Path) -> None:
    looks: list[str] = []
    found = checks.check(path, CheckOptions(), looks.append)
    expected = check_path(path)
    assert len(found.findings) == 1 and looks == [""]
    assert replace(found, seconds=0) == replace(expected, seconds=0)


def test_a_file_that_cannot_be_checked_is_named_and_the_process_continues(checks: CheckProcess, path: Path) -> None:
    missing = path.with_name("missing.obj")
    with pytest.raises(InputError, match=r"missing\.obj: there is no such file"):
        checks.check(missing, CheckOptions(), str)
    pid = checks.pid
    assert len(checks.check(path, CheckOptions(), str).findings) == 1 and checks.pid == pid


def test_a_crash_costs_one_file(checks: CheckProcess, path: Path) -> None:
    checks.check(path, CheckOptions(), str)
    assert checks.pid is not None
    os.kill(checks.pid, signal.SIGKILL if hasattr(signal, "SIGKILL") else signal.SIGTERM)
    with pytest.raises(
        InputError, match=r"crossed\.obj: Blender crashed on this file; save it again in the Blender that made it"
    ):
        checks.check(path, CheckOptions(), str)
    assert len(checks.check(path, CheckOptions(), str).findings) == 1
