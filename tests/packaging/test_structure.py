# SPDX-License-Identifier: GPL-3.0-or-later
"""A test file has the name and folder of a source, or tests/README.md says which behaviour it covers."""

import re
from collections.abc import Iterable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TESTS = [
    path.relative_to(ROOT)
    for folder, pattern in (("tests", "test_*.py"), ("native/tests", "test_*.cpp"))
    for path in sorted((ROOT / folder).rglob(pattern))
]
BEHAVIOURS = set(re.findall(r"^\| `([^`]+)` \|", (ROOT / "tests/README.md").read_text(encoding="utf-8"), re.MULTILINE))
ALIASES = {"bench": "benchmarks"}  # a folder of that name in tests would be imported in its place


def source_folders(test: Path) -> Iterable[Path]:
    """Folders whose sources the tests in this folder may be named after."""
    native = test.parts[0] == "native"
    room = Path(*test.parts[2 if native else 1 : -1][:1])
    yield from (ROOT / "native/src" / room, ROOT / "native/include/stiv" / room)
    if not native:
        yield ROOT / "python/stiv" / room
        if room.name:  # not the root, with everything that was built
            yield from (ROOT / room, ROOT / ALIASES.get(room.name, room))


def source_names(test: Path) -> set[str]:
    """Names of sources and folders in the rooms of a test, and those of the package's top level."""
    inside = [path for folder in source_folders(test) for path in folder.rglob("*")]
    return {path.stem for path in [*inside, *(ROOT / "python/stiv").glob("*.py")]}


@pytest.mark.parametrize("test", TESTS, ids=str)
def test_a_test_is_named_after_a_source_or_listed_as_a_behaviour(test: Path) -> None:
    name = test.stem.removeprefix("test_")
    mirrors = any(name == source or name.startswith(f"{source}_") for source in source_names(test))
    assert mirrors != (test.as_posix() in BEHAVIOURS or f"{test.parent.as_posix()}/" in BEHAVIOURS)


def test_every_listed_behaviour_exists() -> None:
    assert BEHAVIOURS
    assert not [name for name in BEHAVIOURS if not (ROOT / name).exists()]


def test_every_native_source_and_test_is_compiled() -> None:
    lists = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "native").rglob("CMakeLists.txt"))
    sources = [path for folder in ("src", "tests", "bindings") for path in (ROOT / "native" / folder).rglob("*.cpp")]
    assert sources
    assert not [path for path in sources if not re.search(rf"\b{re.escape(path.name)}\b", lists)]
