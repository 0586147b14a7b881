# SPDX-License-Identifier: GPL-3.0-or-later
"""`stiv batch` on mesh files: results, resuming, workers that die, time limits."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from jobs import NAME, record, results, write_job
from json_schemas import read_valid

import stiv
from blend_fixtures.scenes.primitives import icosphere
from stiv.command_line import program
from stiv.mesh_files import read_mesh, write_mesh
from stiv.mesh_files.mesh import checked_mesh


def run(job, *options):
    return program.run(["batch", str(job), "--workers", "2", *options])


def test_every_scene_gets_its_result_and_the_report_says_what_it_took(tmp_path, capsys):
    job, report = write_job(tmp_path, 3), tmp_path / "report.json"
    assert run(job, "--report", str(report)) == 0
    assert "3 of 3 scenes done (0 by an earlier run)" in capsys.readouterr().out
    data = read_valid(report, "batch_report")
    assert [(entry["name"], entry["exit_code"], entry["attempts"]) for entry in data["entries"]] == [
        (NAME.format(number), 0, 1) for number in range(3)
    ]
    assert all(entry["seconds"] > 0 and entry["peak_megabytes"] > 10 for entry in data["entries"])
    for number in range(3):
        before = read_mesh(tmp_path / f"in/{number}.npz")
        after = read_mesh(tmp_path / f"out/result {number}.npz")
        assert len(stiv.find_intersections(after.vertices, after.triangles)) == 0
        assert 0.1 < abs(after.vertices - before.vertices).max() < 2


def test_what_is_finished_is_skipped_until_its_input_or_output_changes(tmp_path, capsys):
    job = write_job(tmp_path, 3)
    assert run(job) == 0
    wanted = results(tmp_path)
    assert run(job, "--resume") == 0
    assert "(3 by an earlier run)" in capsys.readouterr().out
    (tmp_path / "out/result 1.npz").write_bytes(b"torn")
    script = tmp_path / "in/2.json"
    script.write_text(script.read_text().replace("-0.2", "-0.25"))
    assert run(job, "--resume") == 0
    assert "(1 by an earlier run)" in capsys.readouterr().out
    changed = results(tmp_path)
    assert [name for name in wanted if changed[name] != wanted[name]] == ["result 2.npz"]
    assert run(job) == 0
    assert "(0 by an earlier run)" in capsys.readouterr().out


def test_a_bad_scene_costs_only_itself(tmp_path, capsys):
    job = write_job(tmp_path, 3)
    (tmp_path / "in/0.npz").write_bytes(b"no archive")
    (tmp_path / "in/1.npz").unlink()
    assert run(job) == 2
    out = capsys.readouterr().out
    assert "scene 000 ü: bad input" in out and "not a readable NPZ archive" in out
    assert "scene 001 ü: bad input" in out and "cannot be read" in out
    assert list(results(tmp_path)) == ["result 2.npz"]
    assert run(job, "--resume") == 2
    assert "(1 by an earlier run)" in capsys.readouterr().out


def test_a_bad_job_ends_with_2_and_names_the_entry(tmp_path, capsys):
    job = tmp_path / "job.json"
    job.write_text('{"schema": "stiv-batch", "version": 2, "entries": [{"name": "x", "command": "melt"}]}')
    assert run(job) == 2
    assert 'job.json: entry 0 ("x"): "command" is' in capsys.readouterr().err


def test_a_scene_over_its_time_is_given_up_after_one_retry(tmp_path, capsys):
    job = write_job(tmp_path, 1, repeat=2000, time_limit=1.5)
    assert run(job) == 3
    assert "took longer than 1.5 s" in capsys.readouterr().out
    assert record(tmp_path, 0)["attempts"] == 2 and results(tmp_path) == {}


def test_parts_together_make_the_whole(tmp_path):
    job = write_job(tmp_path, 3)
    assert run(job, "--part", "1/2") == 0
    assert list(results(tmp_path)) == ["result 0.npz", "result 2.npz"]
    assert run(job, "--part", "2/2") == 0
    assert len(results(tmp_path)) == 3


def test_meshes_are_checked_and_repaired(tmp_path, capsys):
    ball = icosphere(2, 1.0)
    corners = ball.vertices.copy()
    corners[corners[:, 2] > 0.9] -= (0, 0, 2.2)  # the cap is pushed out through the bottom
    write_mesh(tmp_path / "dented.npz", checked_mesh(corners, ball.triangles(), ("Ball",)))
    entries = [
        {"name": "look", "command": "check", "scene": "dented.npz", "report": "look.json"},
        {"name": "mend", "command": "repair", "scene": "dented.npz", "output": "mended.npz", "report": "mend.json"},
    ]
    job = tmp_path / "job.json"
    job.write_text(json.dumps({"schema": "stiv-batch", "version": 2, "entries": entries}))
    assert run(job) == 4
    out = capsys.readouterr().out
    assert "look: not free" in out and "2 of 2 scenes done" in out
    mended = (tmp_path / "mended.npz").exists()
    assert json.loads((tmp_path / "mend.json").read_text())["free"] and mended and "mend: done" in out


def test_one_process_at_a_time_runs_a_job(tmp_path, capsys):
    job = write_job(tmp_path, 1, repeat=2000)
    with started(job) as other:
        wait_for(lambda: (tmp_path / "job ü.state/workers.log").exists())
        assert run(job) == 2
        assert "another process is running this job" in capsys.readouterr().err
        if sys.platform == "win32":
            other.kill()  # only a program of the same console can send Ctrl+Break
        else:
            other.send_signal(signal.SIGTERM)
        assert other.wait(30) == (1 if sys.platform == "win32" else 5)
    assert results(tmp_path) == {}


def test_workers_that_cannot_start_are_reported(tmp_path, capsys):
    job = write_job(tmp_path, 1)
    assert run(job, "--blender", sys.executable) == 2  # which refuses Blender's arguments
    assert "worker processes in a row ended before they were ready" in capsys.readouterr().err


@pytest.mark.skipif(sys.platform != "linux", reason="finds worker processes in /proc")
def test_killed_workers_cost_a_retry_and_a_killed_parent_a_second_run(tmp_path):
    undisturbed, disturbed = tmp_path / "one", tmp_path / "two"
    undisturbed.mkdir(), disturbed.mkdir()
    assert run(write_job(undisturbed, 8)) == 0
    job = write_job(disturbed, 8)
    with started(job) as parent:
        wait_for(lambda: len(list((disturbed / "out").glob("result*"))) >= 2)
        os.kill(workers_of(parent.pid)[0], signal.SIGKILL)
        wait_for(lambda: len(list((disturbed / "out").glob("result*"))) >= 4)
        orphans = workers_of(parent.pid)
        parent.kill()
        parent.wait()
    wait_for(lambda: not any(is_alive(pid) for pid in orphans))  # they end by themselves
    (disturbed / "out/.result 0-0123abcd.npz").write_bytes(b"half")  # as a kill in the middle of writing leaves
    assert run(job, "--resume") == 0
    assert results(disturbed) == results(undisturbed)
    assert any(record(disturbed, number)["attempts"] == 1 for number in range(8))


def started(job) -> subprocess.Popen:
    packages = [str(Path(package.__file__).parents[1]) for package in (stiv, np)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(packages)}
    command = [sys.executable, "-m", "stiv.command_line", "batch", str(job), "--workers", "2"]
    return subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def workers_of(parent: int) -> list[int]:
    return [int(pid) for pid in Path(f"/proc/{parent}/task/{parent}/children").read_text().split()]


def is_alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def wait_for(condition, seconds: float = 120) -> None:
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.02)
