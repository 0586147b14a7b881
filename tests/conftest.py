# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by all tests: the add-on, the marker for Blender, no deadlines, and an exit that avoids Blender's crash."""

import hashlib
import importlib.util
import os
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.examples import examples

# A busy machine or an emulator must not fail a test: neither an example nor its generation has a deadline.
settings.register_profile(
    "untimed", deadline=None, max_examples=examples(100), suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("untimed")

ROOT = Path(__file__).resolve().parents[1]
ADDON = ROOT / "addon"

EXIT_CODE = pytest.StashKey[int]()

if importlib.util.find_spec("stiv_addon") is None:  # not installed with the wheel: under the name that this gives it
    spec = importlib.util.spec_from_file_location(
        "stiv_addon", ADDON / "__init__.py", submodule_search_locations=[str(ADDON)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules["stiv_addon"] = module
    spec.loader.exec_module(module)


@pytest.fixture(scope="module")
def registered() -> Iterator[None]:
    """The add-on registered for the tests of a file."""
    import stiv_addon  # needs bpy once it registers, which not every test has

    stiv_addon.register()
    yield
    stiv_addon.unregister()


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark the tests in tests/blender, and those of every module that imports bpy; leave shared ones to other Blenders.

    Tests that are named in the command line, and all with STIV_LONG=1, run on every Blender.
    """
    for item in items:
        if item.path.parent.name == "blender" or "bpy" in vars(getattr(item, "module", None) or object):
            item.add_marker(pytest.mark.blender)
    if "bpy" in sys.modules and "STIV_LONG" not in os.environ and not any("::" in name for name in config.args):
        leave_to_other_blenders(config, items)


def leave_to_other_blenders(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselect the shared tests of other Blenders. The name of a test decides, so that each runs on one of them."""
    import bpy

    table = tomllib.loads((ROOT / "tools/blender_versions.toml").read_text())
    versions = table[f"{sys.version_info.major}.{sys.version_info.minor}"]["blender"]
    here = ".".join(map(str, bpy.app.version))
    if here not in versions:
        return
    kept, others = list[pytest.Item](), list[pytest.Item]()
    for item in items:
        number = int.from_bytes(hashlib.sha256(item.nodeid.encode()).digest(), "big")
        is_other = item.get_closest_marker("shared") and here != versions[number % len(versions)]
        (others if is_other else kept).append(item)
    config.hook.pytest_deselected(items=others)
    items[:] = kept


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_sessionfinish(session: pytest.Session) -> Iterator[None]:
    """Store the exit code for pytest_unconfigure, which does not receive it."""
    yield
    session.config.stash[EXIT_CODE] = int(session.exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    """Exit at once if Blender is loaded: 4.2 crashes and 4.5 hangs when Python exits with registered classes."""
    if "bpy" in sys.modules:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(config.stash.get(EXIT_CODE, 0))
