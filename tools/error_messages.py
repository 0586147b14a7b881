# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists the messages of `stiv.blender` that Blender shows, as templates with {} for each part that varies.

These are texts of errors and of their notes, values of dictionaries named ..._REASONS, texts assigned to `reason`,
templates of `fit_message`, and texts that functions named ..._note, ..._message, ..._failure or ..._text return. A
name and a colon at the beginning are left out: "{}: its scale is zero; change it" is listed as "its scale is zero;
change it".
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "python/stiv/blender"
ELSEWHERE = ("scripts", "animation", "settings.py", "motion.py", "frame_check.py")  # of scripts and commands
ERRORS = {"InputError", "UnsupportedStackError", "SceneChangedError", "StartIntersectsError", "add_note", "WriteReport"}
RETURNING = ("note", "message", "failure", "text")
LETTERS = 5  # a template with fewer only joins parts


def templates(folder: Path = PACKAGE) -> set[str]:
    """All templates in the sources of a folder."""
    paths = [path for path in sorted(folder.rglob("*.py")) if not {*path.parts, path.name} & {*ELSEWHERE}]
    texts = {text for path in paths for text in in_source(path.read_text(encoding="utf-8"))}
    bodies = {re.sub(r"^(\{\}(\{\}| and \{\})?: )+", "", text) for text in texts}
    return {body for body in bodies if sum(map(str.isalpha, body)) >= LETTERS}


def in_source(source: str) -> Iterator[str]:
    """The templates of one source."""
    for node in ast.walk(ast.parse(source)):
        for value in values(node):
            yield from alternatives(value)


def values(node: ast.AST) -> list[ast.expr]:
    """The expressions in a node that are messages."""
    if isinstance(node, ast.Call):
        name = getattr(node.func, "id", getattr(node.func, "attr", ""))
        return node.args[:1] if name == "fit_message" else node.args if name in ERRORS else []
    if isinstance(node, ast.Assign):
        target = ast.unparse(node.targets[0])
        if target.endswith("REASONS") and isinstance(node.value, ast.Dict):
            return node.value.values
        return [node.value] if target == "reason" else []
    if isinstance(node, ast.FunctionDef) and node.name.endswith(RETURNING):
        return [each.value for each in ast.walk(node) if isinstance(each, ast.Return) and each.value is not None]
    return []


def alternatives(value: ast.expr) -> Iterator[str]:
    """The templates of an expression."""
    if isinstance(value, ast.IfExp):
        yield from alternatives(value.body)
        yield from alternatives(value.orelse)
    elif isinstance(value, ast.JoinedStr):
        yield "".join(str(part.value) if isinstance(part, ast.Constant) else "{}" for part in value.values)
    elif isinstance(value, ast.Constant) and isinstance(value.value, str):
        yield re.sub(r"\{\w*\}", "{}", value.value)
    elif isinstance(value, ast.BinOp) and isinstance(value.op, ast.Add):
        yield from (left + right for left in alternatives(value.left) or "{}" for right in alternatives(value.right))
    elif isinstance(value, ast.Call | ast.Name | ast.Attribute | ast.Subscript):
        yield "{}"


if __name__ == "__main__":
    print("\n".join(sorted(templates())))
