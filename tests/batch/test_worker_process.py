# SPDX-License-Identifier: GPL-3.0-or-later
"""A worker process: what its environment tells it."""

import json
import os
import queue
import subprocess
import sys

import pytest
from jobs import ball_and_wall, edits

import stiv
from stiv.batch.worker import MARK, shortened
from stiv.batch.worker_process import PACKAGES, WorkerProcess
from stiv.command_line.batch import headline, worker_command
from stiv.mesh_files import write_mesh

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


def test_a_killed_worker_is_reported_and_a_command_after_it_too():
    replies = queue.Queue()
    worker = WorkerProcess(worker_command(""), lambda of, reply: replies.put(reply))
    assert replies.get(timeout=120)["ready"]
    worker.send(7, ["self-test", "--help"])
    reply = replies.get(timeout=60)
    assert (reply["number"], reply["exit_code"]) == (7, 0) and reply["peak_megabytes"] > 10
    worker.kill()
    assert replies.get(timeout=60) is None
    worker.send(8, [])  # into a closed pipe


def test_a_worker_ends_when_its_owner_is_gone(tmp_path):
    (tmp_path / "e.json").write_text(json.dumps(edits(0, 100000)))
    write_mesh(tmp_path / "m.npz", ball_and_wall(0))
    request = {"number": 0, "arguments": ["replay", str(tmp_path / "m.npz"), str(tmp_path / "e.json")]}
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(PACKAGES), os.environ.get("PYTHONPATH", "")])}
    with subprocess.Popen(
        worker_command(""), env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as worker:
        while "ready" not in worker.stdout.readline():
            assert worker.poll() is None
        worker.stdin.write(json.dumps(request) + "\n")
        worker.stdin.close()  # as the system does when the owner is killed
        assert worker.wait(60) == 0


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
