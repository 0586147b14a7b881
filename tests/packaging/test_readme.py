# SPDX-License-Identifier: GPL-3.0-or-later
"""The example of the README does what the README says."""

import re
from pathlib import Path

import pytest

README = Path(__file__).resolve().parents[2] / "README.md"


def test_python_example_ends_without_intersections(capsys: pytest.CaptureFixture[str]) -> None:
    (example,) = re.findall(r"```python\n(.*?)```", README.read_text(), re.DOTALL)
    exec(compile(example, README.name, "exec"), {})
    status, _rounds, intersections = capsys.readouterr().out.split()
    assert status == "corrected"
    assert intersections == "0"
