# SPDX-License-Identifier: GPL-3.0-or-later
"""What all tests share: which of them need Blender, and an end that no Blender module can spoil."""

import os
import sys
from collections.abc import Iterator

import pytest

EXIT_CODE = pytest.StashKey[int]()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark what is in tests/blender, and the tests of every module that imports bpy."""
    for item in items:
        if item.path.parent.name == "blender" or "bpy" in vars(getattr(item, "module", None) or object):
            item.add_marker(pytest.mark.blender)


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_sessionfinish(session: pytest.Session) -> Iterator[None]:
    """Remember the exit code for pytest_unconfigure, which does not get it."""
    yield
    session.config.stash[EXIT_CODE] = int(session.exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    """Leave at once where Blender was loaded: 4.2 crashes and 4.5 hangs when Python ends with classes registered."""
    if "bpy" in sys.modules:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(config.stash.get(EXIT_CODE, 0))
