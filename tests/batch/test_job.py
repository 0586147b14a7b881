# SPDX-License-Identifier: GPL-3.0-or-later
"""Job files: valid ones are read, and messages name the entry."""

import contextlib
import json
import tempfile
from pathlib import Path

import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from json_schemas import schema_of

import stiv
from stiv.batch.job import Job, parse_job, read_job
from tests.examples import examples

OLD = Path(__file__).with_name("job_of_0.1.0.json")
CHECK = {"name": "a", "command": "check", "scene": "a.blend"}
REPLAY = {
    "name": "b ü",
    "command": "replay",
    "scene": "a.blend",
    "edits": "e.json",
    "output": "b.blend",
    "report": "b.json",
}
CHECK_ALL = {"name": "e", "command": "check", "scene": "a.blend", "scene_name": "B", "render": False, "hidden": True}
CHECK_ALL["guard"] = "render"
RESOLVE = {"name": "c", "command": "resolve", "scene": "a.blend", "frames": "1:9", "output": "c.blend", "hold": ["-x"]}
RESOLVE["guard"] = "both"
REPAIR = {"name": "d", "command": "repair", "scene": "a.blend", "output": "d.blend", "guard": "viewport"}


def job(*entries, **more):
    return {"schema": "stiv-batch", "version": 2, "entries": list(entries), **more}


def test_entries_become_commands_with_paths_of_the_jobs_folder(tmp_path):
    path = tmp_path / "job.json"
    path.write_text(json.dumps(job(CHECK, REPLAY, RESOLVE, REPAIR, CHECK_ALL, time_limit=60)), encoding="utf-8")
    read = read_job(path)
    scene = str(tmp_path / "a.blend")
    assert [entry.arguments for entry in read.entries] == [
        ("check", scene),
        (
            "replay",
            scene,
            str(tmp_path / "e.json"),
            f"--output={tmp_path / 'b.blend'}",
            f"--report={tmp_path / 'b.json'}",
        ),
        ("resolve", scene, f"--output={tmp_path / 'c.blend'}", "--frames=1:9", "--guard=both", "--hold=-x"),
        ("repair", scene, f"--output={tmp_path / 'd.blend'}", "--guard=viewport"),
        ("check", scene, "--scene=B", "--guard=render", "--hidden"),
    ]
    assert read.entries[1].inputs == (tmp_path / "a.blend", tmp_path / "e.json")
    assert read.entries[1].outputs == (tmp_path / "b.blend", tmp_path / "b.json")
    assert read.time_limit == 60


def test_a_job_of_version_0_1_0_is_read(tmp_path):
    data = json.loads(OLD.read_text(encoding="utf-8"))
    new = data | {
        "version": 2,
        "entries": [{{"do": "command"}.get(k, k): v for k, v in entry.items()} for entry in data["entries"]],
    }
    assert [entry["do"] for entry in data["entries"]] == ["replay", "resolve", "repair", "check"]
    assert parse_job(data, tmp_path) == parse_job(new, tmp_path)
    jsonschema.validate(new, schema_of("batch_job"))


WRONG = [
    ({}, 'the field "schema" is not "stiv-batch"'),
    (job() | {"version": 3}, "version 3 is not supported; this program reads 1 and 2"),
    (job() | {"entries": {}}, 'the field "entries" is not a list'),
    (job(colour=1), 'the job: unknown field "colour"'),
    (job(time_limit=-1), '"time_limit" is not a number of seconds'),
    (job(3), "entry 0: not an object"),
    (job(CHECK | {"name": ""}), 'entry 0: "name" must have'),
    (job(CHECK | {"name": "a\nb"}), 'entry 0: "name" must have'),
    (job(CHECK | {"command": "melt"}), 'entry 0 ("a"): "command" is \'melt\', none of check, replay, repair, resolve'),
    (job({"name": "a", "command": "replay", "scene": "x"}), 'entry 0 ("a"): replay needs the field "edits"'),
    (job(CHECK | {"edits": "x"}), 'entry 0 ("a"): unknown field "edits"; the fields are baseline'),
    (job(CHECK | {"scene": 3}), 'entry 0 ("a"): "scene" is not a text'),
    (job(CHECK | {"scene": ""}), 'entry 0 ("a"): "scene" is not the path of a file'),
    (job(CHECK | {"frames": "9:1"}), "entry 0 (\"a\"): frames '9:1' must ascend"),
    (job(CHECK | {"hidden": 1}), 'entry 0 ("a"): "hidden" is neither true nor false'),
    (job(REPAIR | {"guard": "All"}), 'entry 0 ("d"): "guard" is \'All\', none of auto, viewport, render, both'),
    (job(CHECK | {"scene_name": 1}), 'entry 0 ("a"): "scene_name" is not a text'),
    (job(CHECK | {"objects": "x"}), 'entry 0 ("a"): "objects" is not a list of object names'),
    (job(CHECK, CHECK), 'entry 1: entry 0 also has the name "a"'),
    (job(REPLAY, REPAIR | {"output": "b.blend"}), 'entry 1 ("d"): '),
    (job(CHECK, REPAIR | {"output": "a.blend"}), 'entry 0 ("a"): '),
]


@pytest.mark.parametrize(("data", "message"), WRONG, ids=[message for _, message in WRONG])
def test_what_is_wrong_is_named(data, message, tmp_path):
    with pytest.raises(stiv.InputError) as raised:
        parse_job(data, tmp_path)
    assert message in str(raised.value)


def test_the_schema_takes_what_the_reader_takes():
    entries = (CHECK, REPLAY, RESOLVE, REPAIR, CHECK_ALL)
    jsonschema.validate(job(*entries, time_limit=60, description="x"), schema_of("batch_job"))
    refused = [data for data, message in WRONG if not accepted_by_schema(data)]
    assert len(refused) >= len(WRONG) - 6  # repeated names and paths are beyond a schema


def accepted_by_schema(data) -> bool:
    try:
        jsonschema.validate(data, schema_of("batch_job"))
    except jsonschema.ValidationError:
        return False
    return True


JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.sampled_from([*REPLAY, *RESOLVE, "x"]), inner),
    max_leaves=12,
)


@settings(max_examples=examples(120), deadline=None)
@given(st.lists(JSON | st.builds(lambda extra: CHECK | extra, st.dictionaries(st.sampled_from([*REPLAY]), JSON))))
def test_anything_is_a_job_or_an_input_error(entries):
    with contextlib.suppress(stiv.InputError):
        assert isinstance(parse_job(job(*entries), Path("/nowhere")), Job)


@settings(max_examples=examples(200), deadline=None)
@given(st.binary(max_size=300))
def test_any_bytes_are_a_job_or_an_input_error(data):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "job.json"
        path.write_bytes(data)
        try:
            read_job(path)
        except stiv.InputError as error:
            assert str(path) in str(error)
