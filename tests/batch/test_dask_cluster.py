# SPDX-License-Identifier: GPL-3.0-or-later
"""The same job on a local Dask cluster of two workers: the same bytes."""

import pytest
from jobs import results, write_job

from stiv.command_line import program

distributed = pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def scheduler():
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1"
    ) as cluster:
        yield cluster.scheduler_address


def test_a_cluster_gives_the_results_of_one_machine(tmp_path, scheduler, capsys):
    for name in ("here", "there"):
        (tmp_path / name).mkdir()
    assert program.run(["batch", str(write_job(tmp_path / "here", 5)), "--workers", "1"]) == 0
    job = str(write_job(tmp_path / "there", 5))
    assert program.run(["batch", job, "--scheduler", scheduler]) == 0
    assert results(tmp_path / "there") == results(tmp_path / "here")
    assert program.run(["batch", job, "--scheduler", scheduler, "--resume"]) == 0
    assert "(5 by an earlier run)" in capsys.readouterr().out


def test_a_bad_scene_costs_only_itself(tmp_path, scheduler, capsys):
    job = write_job(tmp_path, 2)
    (tmp_path / "in/0.npz").write_bytes(b"no archive")
    assert program.run(["batch", str(job), "--scheduler", scheduler]) == 2
    assert "scene 000 ü: bad input" in capsys.readouterr().out and len(results(tmp_path)) == 1


def test_a_scheduler_that_is_not_there_ends_with_2(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("stiv.batch.dask_cluster.CONNECT_LIMIT", 1)
    assert program.run(["batch", str(write_job(tmp_path, 1)), "--scheduler", "tcp://127.0.0.1:9"]) == 2
    assert "does not answer" in capsys.readouterr().err
