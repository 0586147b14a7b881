# SPDX-License-Identifier: GPL-3.0-or-later
"""Outputs are complete or absent."""

import os

import pytest

import stiv
from stiv.json_files import write_json
from stiv.output_files import resolved, written_atomically


def test_an_output_replaces_the_old_file(tmp_path):
    path = tmp_path / "a ü.json"
    path.write_text("old")
    write_json(path, {"name": "ü"})
    assert path.read_text(encoding="utf-8") == '{\n  "name": "ü"\n}\n'
    assert os.listdir(tmp_path) == [path.name]


def test_an_error_while_writing_preserves_the_old_file(tmp_path):
    path = tmp_path / "a.json"
    path.write_text("old")

    def fail_half_way():
        with written_atomically(path) as temporary:
            temporary.write_text("half")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail_half_way()
    assert path.read_text() == "old" and os.listdir(tmp_path) == ["a.json"]


def test_a_path_that_cannot_be_written_is_named(tmp_path):
    with pytest.raises(stiv.InputError, match=r"a\.json: cannot be written"):
        write_json(tmp_path / "nowhere" / "a.json", {})


def test_a_path_that_windows_cannot_follow_stays_as_it_is(tmp_path, monkeypatch):
    def refuse(*_, **__):
        raise OSError(234, "more data available")

    assert resolved(tmp_path / "a" / ".." / "j.json") == tmp_path.resolve() / "j.json"
    monkeypatch.setattr(type(tmp_path), "resolve", refuse)
    assert resolved(tmp_path / "j.json") == tmp_path / "j.json"
