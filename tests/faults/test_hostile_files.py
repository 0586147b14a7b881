# SPDX-License-Identifier: GPL-3.0-or-later
"""Random and mutated files are read, or refused by name, without a crash or hang."""

import contextlib
import faulthandler
import io
import json
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import stiv
from stiv.batch.job import read_job
from stiv.checks.baseline import read_baseline
from stiv.command_line import program
from stiv.edit_scripts import read_edit_script
from stiv.mesh_files import read_mesh

HANG = 60  # seconds, because other tests run in parallel; the fuzzer runs alone and allows ten
CORPUS = Path(__file__).parent / "hostile_files"
FEW = settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))


def npz() -> bytes:
    stream = io.BytesIO()
    np.savez(stream, vertices=np.eye(3), triangles=np.array([[0, 1, 2]]), object_names=np.array(["a"]))
    return stream.getvalue()


VALID = {
    ".npz": (read_mesh, npz()),
    ".obj": (read_mesh, b"o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/2 -1\nl 1 2\n"),
    ".ply": (
        read_mesh,
        b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        b"element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    ),
    ".edits.json": (
        read_edit_script,
        b'{"schema": "stiv-edits", "version": 1, "steps": [{"operator": "move", "objects": ["a"], '
        b'"values": {"value": [0, 0, 1]}}]}',
    ),
    ".job.json": (
        read_job,
        b'{"schema": "stiv-batch", "version": 1, "entries": [{"name": "a", "do": "check", "scene": "a.blend"}]}',
    ),
    ".baseline.json": (
        read_baseline,
        b'{"schema": "stiv-baseline", "version": 1, "accepted": [{"file": "a", "objects": ["a", "b"], '
        b'"kind": "intersection", "pairs": 1}]}',
    ),
}


@contextlib.contextmanager
def hang_guard():
    """End the test run, with a traceback, if reading a file takes this long."""
    faulthandler.dump_traceback_later(HANG, exit=True, file=sys.__stderr__)
    try:
        yield
    finally:
        faulthandler.cancel_dump_traceback_later()


def read(suffix: str, data: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"hostile{suffix}"
        path.write_bytes(data)
        with hang_guard():
            try:
                VALID[suffix][0](path)
            except stiv.InputError as error:
                assert str(path) in str(error)


@pytest.mark.parametrize("suffix", VALID)
def test_inputs_are_valid_before_mutation(suffix, tmp_path):
    path = tmp_path / f"good{suffix}"
    path.write_bytes(VALID[suffix][1])
    VALID[suffix][0](path)


@pytest.mark.parametrize("suffix", VALID)
def test_random_bytes(suffix):
    FEW(given(st.binary(max_size=400))(lambda data: read(suffix, data)))()


@pytest.mark.parametrize("suffix", VALID)
def test_mutated_files(suffix):
    valid = VALID[suffix][1]
    places = st.integers(0, len(valid) - 1)
    changes = st.lists(st.tuples(places, st.integers(0, 3), st.binary(min_size=1, max_size=6)), min_size=1, max_size=5)
    FEW(given(changes)(lambda several: read(suffix, mutated(valid, several))))()


@pytest.mark.parametrize("path", sorted(CORPUS.iterdir()), ids=lambda path: path.name)
def test_the_corpus_of_the_fuzzer(path):
    """Inputs that together reach all code that fuzzing reached (tests/long/file_fuzzing.py)."""
    read("".join(path.suffixes), path.read_bytes())


def mutated(data: bytes, changes) -> bytes:
    """Bytes replaced, inserted, truncated or repeated."""
    for place, kind, piece in changes:
        head, tail = data[:place], data[place:]
        data = [head + piece + tail[len(piece) :], head + piece + tail, head + piece, head + tail[:9] + tail][kind]
    return data


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("pickle.npz", "pickle"),
        ("promise.ply", "ply\nformat ascii 1.0\nelement vertex 2000000000\nproperty float x\nend_header\n0\n"),
        ("numbers.obj", "v 1e999 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n"),
        ("index.obj", "v 0 0 0\nf 1 2 99999999999999999999\n"),
    ],
)
def test_the_command_refuses_malicious_files_with_exit_code_2(tmp_path, capsys, name, data):
    path = tmp_path / name
    if data == "pickle":
        np.savez(path, vertices=np.array([Harm()], dtype=object), triangles=np.zeros((0, 3), int))
    else:
        path.write_text(data)
    with hang_guard():
        assert program.run(["check", str(path)]) == 2
    assert name in capsys.readouterr().err


class Harm:
    """Ends the process when unpickled."""

    def __reduce__(self):
        return (exit, (77,))


def test_a_job_nested_too_deeply_is_refused(tmp_path):
    path = tmp_path / "job.json"
    path.write_text('{"schema":' + "[" * 200_000)
    with hang_guard(), pytest.raises(stiv.InputError, match=r"job\.json"):
        read_job(path)


def test_infinite_time_limits_are_refused(tmp_path):
    path = tmp_path / "job.json"
    path.write_text('{"schema": "stiv-batch", "version": 1, "entries": [], "time_limit": Infinity}')
    with pytest.raises(stiv.InputError, match="time_limit"):
        read_job(path)
    assert json.loads("Infinity") == float("inf")
