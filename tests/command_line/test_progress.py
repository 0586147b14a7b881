# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress bars of commands."""

import contextlib
import io

import pytest

from stiv.command_line.progress import fraction_bar, progress_bar


@pytest.mark.parametrize("bar", [lambda: progress_bar("check", 2), lambda: fraction_bar("repair")])
def test_logs_get_no_progress_bars(bar) -> None:
    pytest.importorskip("rich")
    with contextlib.redirect_stderr(io.StringIO()) as log, bar() as advance:
        advance("a note", 1)
    assert log.getvalue() == ""
