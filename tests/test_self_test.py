# SPDX-License-Identifier: GPL-3.0-or-later
"""The self-test gives the committed hashes for all vector targets and any number of runs."""

import platform
import re
import sys
from pathlib import Path

import pytest

import stiv
from stiv import _native
from stiv.command_line.program import run

CPUINFO = Path("/proc/cpuinfo")
AVX512 = {"avx512f", "avx512dq", "avx512cd", "avx512bw", "avx512vl"}


@pytest.mark.parametrize("target", _native.VectorTarget)
def test_hashes_are_those_committed(target):
    best = _native.best_vector_target()
    if target.value > best.value:
        pytest.skip(f"this processor has no {target.name}")
    _native.limit_vector_target(target)
    try:
        result = stiv.self_test()
    finally:
        _native.limit_vector_target(best)
    assert result.passed, result
    assert result.vectors == target.name


@pytest.mark.skipif(not CPUINFO.is_file() or platform.machine() != "x86_64", reason="reads Linux' list of a processor")
def test_the_vector_instructions_are_the_best_of_this_processor():
    flags = set(re.search(r"^flags\s*:(.*)$", CPUINFO.read_text(), re.MULTILINE)[1].split())
    best = "avx512" if flags >= AVX512 else "avx2" if "avx2" in flags else "baseline"
    assert _native.best_vector_target().name == best


def test_the_command_prints_both_hashes_and_fails_on_other_bits(capsys, monkeypatch):
    assert run(["self-test"]) == 0
    out = capsys.readouterr().out
    result = stiv.self_test()
    assert f"40 edits: {result.edits} (as expected)" in out
    assert f"100,000 intersection tests: {result.intersections} (as expected)" in out
    monkeypatch.setattr(sys.modules["stiv.self_test"], "_hash", lambda arrays: "0" * 16)
    assert run(["self-test"]) == 3
    assert f"0000000000000000 (WRONG: expected {result.edits})" in capsys.readouterr().out
