# SPDX-License-Identifier: GPL-3.0-or-later
"""Drags pause only where a test says so, however slow the machine is."""

import pytest

from stiv_addon.modal import drag_loop


@pytest.fixture(autouse=True)
def without_pauses(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let no pause begin by itself."""
    monkeypatch.setattr(drag_loop, "PAUSE_TIME", 3600.0)
