# SPDX-License-Identifier: GPL-3.0-or-later
import importlib
import sys
from typing import Any

import pytest

from stiv_addon import native_module


def problem_with(monkeypatch: pytest.MonkeyPatch, error: ImportError) -> str:
    def fail(name: str) -> Any:
        raise error

    monkeypatch.setattr(importlib, "import_module", fail)
    return native_module.problem.__wrapped__()


def test_a_missing_module_names_the_version_and_the_way_out(monkeypatch: pytest.MonkeyPatch) -> None:
    text = problem_with(monkeypatch, ModuleNotFoundError("No module named 'stiv._native'", name="stiv._native"))
    assert f"Python {sys.version_info.major}.{sys.version_info.minor} is missing" in text
    assert "Install an extension" in text


def test_a_module_that_does_not_load_says_why(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "GLIBC_2.99 not found" in problem_with(monkeypatch, ImportError("GLIBC_2.99 not found"))


def test_no_problem_is_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib, "import_module", lambda name: None)
    assert native_module.problem.__wrapped__() == ""
