# SPDX-License-Identifier: GPL-3.0-or-later
"""The check of the documents reports each kind of finding at its line, and nothing in exempt text."""

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tools import check_documents, wrap_documents

LIST = check_documents.DIALECT.read_text(encoding="utf-8")
RULES = check_documents.dialect(LIST, "documents")
ROOT = check_documents.ROOT


def lines(findings: Iterator[tuple[int, str]]) -> list[int]:
    return [number for number, _ in findings]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("Rounds ask the kept pairs.", [1]),
        ("# Title\n\nFine.\n\nEverything that\ntakes part is tested.", [5]),
        ("| a | b |\n|---|---|\n| it is told | fine |", [3]),
        ("Fine. What moves is written.", [1]),
        ("It takes 5 ms a round.", [1]),
        ("A [link](kept_pairs.md) and `leave_kept`, and *takes part* as a label.", []),
        ("```\nkept pairs\n```\n\n    kept pairs\n", []),
        ("Write what moves. What you drag is written.", []),
    ],
)
def test_words_of_the_dialect_are_found(text: str, found: list[int]) -> None:
    assert lines(check_documents.wording(text, RULES)) == found


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("int stray_vertices = 1;", [1]),
        ("x = 1\nclass StrayVertices:", [2]),
        ("/// Everything that takes\n    /// part in a round.", [1]),
        ('raise Input_Error("it is told "\n                 "nothing")', [1]),
        ("strayed_ = 1  # told", [1, 1]),
        ("astray = participate(partly)", []),
    ],
)
def test_words_of_the_dialect_are_found_in_code(text: str, found: list[int]) -> None:
    assert lines(check_documents.code_wording(text, check_documents.dialect(LIST, "code"))) == found


@pytest.mark.parametrize(
    ("check", "bad", "good"),
    [
        (check_documents.long_sentences, "- one\n- " + "word " * 26 + ".", "- one\n- " + "word " * 24 + "word."),
        (check_documents.long_lines, "\n" + "word " * 23, "\n| " + "word " * 23),
    ],
)
def test_too_long_sentences_and_lines_are_found(
    check: Callable[[str], Iterator[tuple[int, str]]], bad: str, good: str
) -> None:
    assert lines(check(bad)) == [2]
    assert lines(check(good)) == []


def test_wrapping_changes_only_long_lines() -> None:
    code = "```\n" + "code " * 30 + "\n```\n\n| " + "cell " * 30 + "|\n\n$$\na +\n" + "b " * 70 + "$$\n"
    text = f"# Title\n\n- {'word ' * 21}`a span of code` - and $x + y$\n  more\n\n{code}"
    wrapped = wrap_documents.wrapped(text)
    assert wrapped.split("\n")[2:5] == [f"- {('word ' * 21).strip()}", "  `a span of code` - and $x + y$ more", ""]
    assert wrapped.endswith(code)
    assert wrap_documents.wrapped(wrapped) == wrapped


@pytest.mark.parametrize("path", check_documents.files(".md"), ids=lambda path: path.name)
def test_wrapping_keeps_every_word(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert wrap_documents.wrapped(text).split() == text.split()


def test_broken_links_are_found(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("[itself](page.md)\n[none](gone.md#x) [web](https://example.org/gone.md)\n")
    assert list(check_documents.broken_links(page)) == [(2, "there is no gone.md")]


def test_references_to_missing_sections_and_equations_are_found(tmp_path: Path) -> None:
    page = "mathematics.md"
    (tmp_path / page).write_text("## The loop\n\n$$x \\tag{2}$$\n")
    good = f'/// ({page}, "The\n/// loop") [P4; {page},\n/// "The loop"] ({page}, Eq. 2)'
    assert list(check_documents.broken_references(good, tmp_path)) == []
    bad = f'fine\n// ({page}, "The knot")\n// ({page}, Eq. 3)'
    assert lines(check_documents.broken_references(bad, tmp_path)) == [2, 3]


def test_the_code_cites_the_mathematics() -> None:
    texts = [path.read_text(encoding="utf-8") for path in check_documents.files(".hpp", ".cpp")]
    assert sum(len(check_documents.REFERENCE.findall(text)) for text in texts) > 30
    assert not [text for text in texts if "DESIGN" in text]


@pytest.mark.parametrize("folder", ["native", "python/stiv/blender", "addon"])
def test_the_map_names_existing_files_and_folders(folder: str) -> None:
    text = (ROOT / "docs/architecture.md").read_text(encoding="utf-8")
    table = text.split(f"### `{folder}`")[1].split("\n#")[0]
    named = {name for row in table.splitlines() if row.startswith("| `") for name in re.findall(r"`(\w+)`", row)}
    assert len(named) > 5
    assert named - {"f"} <= {path.stem for path in (ROOT / folder).rglob("*")}


def test_the_map_names_every_room() -> None:
    text = (ROOT / "docs/architecture.md").read_text(encoding="utf-8")
    for parent in ("native/src", "python/stiv", "python/stiv/blender", "addon"):
        rooms = {path.parent.name for path in (ROOT / parent).glob("*/*") if path.suffix in (".py", ".cpp")}
        assert {room for room in rooms if f"`{room}`" not in text} <= {
            "__pycache__",
            "vector",
            "translations",
            "schemas",
        }
