# SPDX-License-Identifier: GPL-3.0-or-later
"""Wrap the lines of Markdown documents at the width of check_documents.py.

Usage: wrap_documents.py FILE... Code, tables, headings, pictures and display equations do not change; code
spans and formulas are not broken, and no line starts like an item of a list.
"""

import re
import sys
from collections.abc import Iterator
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from check_documents import WIDTH

UNBROKEN = re.compile(r"\$[^$]+\$|`[^`]+`")
ITEM = re.compile(r"\s*([-*]|\d+\.) ")
NO_BEGINNING = re.compile(r"[-+*=#>]$|\d+[.)]$|[=#>]")
AS_IT_IS = ("|", "#", "<", "![", "---")


def words(text: str) -> list[str]:
    """Words and unbreakable spans."""
    spans: list[str] = []

    def hidden(found: re.Match[str]) -> str:
        spans.append(" ".join(found[0].split()))
        return f"\0{len(spans) - 1}\0"

    return [re.sub(r"\0(\d+)\0", lambda m: spans[int(m[1])], word) for word in UNBROKEN.sub(hidden, text).split()]


def filled(text: str, first: str, indent: str) -> Iterator[str]:
    """The lines of one paragraph or item."""
    line = first
    for word in words(text):
        if line.strip() and line != first and len(line) + 1 + len(word) > WIDTH and not NO_BEGINNING.match(word):
            yield line
            line = indent + word
        else:
            line += word if line in (first, indent) else f" {word}"
    yield line


def wrapped(document: str) -> str:
    """A document with its paragraphs and items wrapped again."""
    lines: list[str] = []
    paragraph: list[str] = []
    first = indent = ""
    fence = equation = comment = False
    for line in document.split("\n"):
        text = line.strip()
        kept = fence or equation or comment or not text or text.startswith((*AS_IT_IS, "```", "$$"))
        item = ITEM.match(line)
        if paragraph and (kept or item):
            lines += filled(" ".join(paragraph), first, indent)
            paragraph = []
        fence ^= text.startswith("```")
        equation ^= not fence and text.count("$$") % 2 == 1
        comment = (comment or "<!--" in text) and "-->" not in text
        if kept or (line.startswith("    ") and not paragraph):
            lines.append(line)
            continue
        if item:
            first, indent, text = item[0], " " * len(item[0]), line[item.end() :]
        elif not paragraph:
            first = indent = line[: len(line) - len(line.lstrip())]
        paragraph.append(text)
    return "\n".join([*lines, *(filled(" ".join(paragraph), first, indent) if paragraph else [])])


if __name__ == "__main__":
    for name in sys.argv[1:]:
        path = Path(name)
        path.write_text(wrapped(path.read_text(encoding="utf-8")), encoding="utf-8")
