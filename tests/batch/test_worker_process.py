# SPDX-License-Identifier: GPL-3.0-or-later
"""A worker process: what its environment tells it."""

import queue
import sys

import pytest

import stiv
from stiv.batch.worker import MARK, shortened
from stiv.batch.worker_process import WorkerProcess
from stiv.command_line.batch import headline

TELL_THREADS = f"import os, json; print({MARK!r} + json.dumps({{'threads': os.environ['STIV_THREADS']}}))"


def threads_given(threads):
    replies = queue.Queue()
    worker = WorkerProcess([sys.executable, "-c", TELL_THREADS], lambda of, reply: replies.put(reply), threads=threads)
    try:
        return replies.get(timeout=60)["threads"]
    finally:
        worker.kill()


@pytest.mark.parametrize(("user", "threads", "expected"), [(None, 3, "3"), ("5", 3, "5")])
def test_a_worker_edits_with_its_share_of_threads_unless_the_user_says_another(monkeypatch, user, threads, expected):
    monkeypatch.delenv("STIV_THREADS", raising=False)
    if user is not None:
        monkeypatch.setenv("STIV_THREADS", user)
    assert threads_given(threads) == expected


def test_a_wrong_number_of_threads_is_an_error_of_the_input(monkeypatch):
    monkeypatch.setenv("STIV_THREADS", "all")
    with pytest.raises(stiv.InputError, match="STIV_THREADS: expected a whole number"):
        stiv.Detector([[0, 1, 2]]).find([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [1, 0, 0], [0, 1, 0]])


def test_of_a_long_message_the_first_line_and_the_end_are_kept_and_the_result_is_shown():
    said = "scene.blend: 4,224 intersecting pairs\n" + "  a pair\n" * 1000 + "  ... and 4,214 more"
    kept = shortened(said)
    assert len(kept) == 2000 and kept.endswith("  ... and 4,214 more")
    assert headline(kept, 4) == "scene.blend: 4,224 intersecting pairs"
    assert headline("note\nstiv: scene.blend: cannot be read", 2) == "stiv: scene.blend: cannot be read"
    assert shortened("short") == "short" and len(shortened("x" * 9999)) == 2000
