# SPDX-License-Identifier: GPL-3.0-or-later
"""Griffe extension for the site: sets aligned lists of docstrings as tables, and reads `#:` comments of attributes.

An aligned list is a paragraph of lines "name   meaning" or "name: meaning"; indented lines continue the meaning.
"""

import re
from typing import Any

import griffe

NATIVE = {  # classes of the compiled module, whose stub has no docstrings
    "InputError": "Invalid input. The message names the object and the element, and how to continue. Nothing changed.",
    "InfeasibleError": "A deformation has no surface at these controls. Nothing changed.",
    "StartIntersectsError": "The start of an edit intersects: `pairs` of triangles, (P, 2). Repair or exclude them.",
    "CancelledError": "The job was cancelled; nothing changed.",
}
ITEM = re.compile(r"^(\S.*?(?=  )|[a-z_]\w*(?=: )):? +(\S.*)$")


class PlainDocstrings(griffe.Extension):
    """Rewrites the docstrings of the package."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Called by griffe for each module, class, function and attribute."""
        if obj.docstring:
            obj.docstring.value = with_tables(obj.docstring.value)
        elif text := NATIVE.get(obj.name, "") or attribute_comment(obj):
            obj.docstring = griffe.Docstring(text, parent=obj)


def with_tables(text: str) -> str:
    """A docstring with its aligned lists as tables; other paragraphs stay."""
    return "\n\n".join(table(block) or block for block in text.split("\n\n"))


def table(block: str) -> str:
    """The table of an aligned list; empty for any other paragraph."""
    items = list[tuple[str, str]]()
    for line in block.split("\n"):
        found = ITEM.match(line)
        if found:
            items.append((found[1], found[2]))
        elif items and line.startswith(" "):
            items[-1] = (items[-1][0], f"{items[-1][1]} {line.strip()}")
        else:
            return ""
    rows = [f"| `{name}` | {escaped(meaning)} |" for name, meaning in items]
    return "\n".join(["| argument | meaning |", "|---|---|", *rows])


def escaped(text: str) -> str:
    """A text without the separator of a table's cells."""
    return text.replace("|", "\\|")


def attribute_comment(obj: griffe.Object) -> str:
    """The comment after an attribute in its line, or in the lines above it."""
    if not obj.is_attribute or not obj.lineno:
        return ""
    lines = list(obj.lines_collection[obj.filepath])
    number = obj.lineno
    after = lines[number - 1].partition("#: ")[2]
    above = list[str]()
    for line in reversed(lines[: number - 1]):
        if not line.strip().startswith("#: "):
            break
        above.insert(0, line.strip().removeprefix("#: "))
    return after or " ".join(above)
