# SPDX-License-Identifier: GPL-3.0-or-later
"""The types of the compiled module: those in the package are those of the module."""

from tools.native_stub import STUB, stub_text


def test_the_stub_is_that_of_the_module() -> None:
    assert STUB.read_text(encoding="utf-8") == stub_text(), "run tools/native_stub.py"
