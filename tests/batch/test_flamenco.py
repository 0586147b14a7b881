# SPDX-License-Identifier: GPL-3.0-or-later
"""The job type for Flamenco, run by a JavaScript engine against a stand-in for the job compiler. No farm was run."""

import importlib.resources
import json
import shutil
import subprocess
from pathlib import Path

import pytest
from jobs import results, write_job

from stiv.command_line import program

ENGINE = next((path for name in ("duk", "qjs", "node") if (path := shutil.which(name))), None)
FIRST, SECOND = Path(__file__).with_name("flamenco_stand_in.js").read_text().split("//====")
JOB_TYPE = importlib.resources.files("stiv.batch").joinpath("stiv_batch_flamenco.js").read_text()

pytestmark = pytest.mark.skipif(ENGINE is None, reason="no JavaScript engine: duktape, quickjs or nodejs of Debian")


def compiled(folder: Path, **settings):
    source = folder / "compile.js"
    source.write_text(f"{FIRST}\n{JOB_TYPE}\nvar GIVEN = {json.dumps(settings)};\n{SECOND}")
    ended = subprocess.run([ENGINE, str(source)], capture_output=True, text=True, check=True)
    return json.loads(ended.stdout)


def test_each_part_becomes_a_task(tmp_path):
    tasks = compiled(tmp_path, job_file="/shared/job ü.json", parts=3)["tasks"]
    assert [task["name"] for task in tasks] == ["scenes-1-of-3", "scenes-2-of-3", "scenes-3-of-3"]
    (command,) = tasks[1]["commands"]
    arguments = ["batch", "/shared/job ü.json", "--resume", "--part", "2/3", "--workers", "1"]
    assert command == {"name": "exec", "parameters": {"exe": "stiv", "args": arguments}}


def test_a_blender_is_passed_on(tmp_path):
    (task,) = compiled(tmp_path, job_file="j", parts=1, blender="{blender}", stiv="{stiv}")["tasks"]
    parameters = task["commands"][0]["parameters"]
    assert parameters["exe"] == "{stiv}" and parameters["args"][-2:] == ["--blender", "{blender}"]


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({}, "job_file is required"),
        ({"job_file": ""}, "job_file: which"),
        ({"job_file": "j", "parts": 0}, "parts: 0 is not"),
        ({"job_file": "j", "workers": 0}, "workers: 0 is not"),
    ],
)
def test_wrong_settings_are_reported(tmp_path, settings, message):
    assert message in compiled(tmp_path, **settings)["error"]


def test_the_commands_of_all_tasks_together_run_the_job(tmp_path):
    tasks = compiled(tmp_path, job_file=str(write_job(tmp_path, 3)), parts=2)["tasks"]
    assert [program.run(command["parameters"]["args"]) for task in tasks for command in task["commands"]] == [0, 0]
    assert len(results(tmp_path)) == 3
