# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests named in docs/faults.md exist."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
NAMED = re.findall(r"`((?:tests|native)/[^`]+)::([^`]+)`", (ROOT / "docs/faults.md").read_text())


def test_there_are_rows():
    assert len(NAMED) > 50


@pytest.mark.parametrize(("path", "name"), NAMED, ids=["::".join(named) for named in NAMED])
def test_the_test_exists(path, name):
    text = (ROOT / path).read_text(encoding="utf-8")
    if path.startswith("native"):
        assert re.search(rf'TEST_CASE\("[^"]*{re.escape(name)}', text)
    else:
        assert re.search(rf"^def {name}\(", text, re.MULTILINE)
