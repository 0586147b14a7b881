# SPDX-License-Identifier: GPL-3.0-or-later
"""The lock of a job, and signals that end a batch, on Windows too."""

from __future__ import annotations

import signal
import sys
import types
from pathlib import Path

import pytest

from stiv import InputError
from stiv.batch import run
from stiv.command_line import batch, program
from tests.batch.jobs import write_job


def test_the_lock_of_a_job_on_windows_is_that_of_its_c_runtime(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    locked: list[tuple[int, int]] = []

    def locking(_: int, mode: int, count: int) -> None:
        if locked:
            raise PermissionError(13, "Permission denied")
        locked.append((mode, count))

    monkeypatch.setitem(sys.modules, "msvcrt", types.SimpleNamespace(LK_NBLCK=2, locking=locking))
    monkeypatch.setattr(sys, "platform", "win32")
    with run._locked(tmp_path, "lock"):
        assert locked == [(2, 1)]
        with pytest.raises(InputError, match="another process is running this job"), run._locked(tmp_path, "lock"):
            pass


@pytest.mark.parametrize("name", sorted({"SIGINT", "SIGTERM", "SIGBREAK"} & set(dir(signal))))
def test_a_signal_of_the_system_cancels_a_batch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    signals = [signal.Signals[each] for each in ("SIGINT", "SIGTERM", name)]
    handlers = {each: signal.getsignal(each) for each in signals}
    monkeypatch.setattr(batch, "run_job", lambda *_: signal.raise_signal(signal.Signals[name]))
    signal.signal(signal.SIGINT, signal.default_int_handler)  # Python ignores it where a shell started it with "&"
    try:
        assert program.run(["batch", str(write_job(tmp_path, 1)), "--workers", "1"]) == 5
    finally:
        for each, handler in handlers.items():
            signal.signal(each, handler)
