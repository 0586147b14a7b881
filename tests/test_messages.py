# SPDX-License-Identifier: GPL-3.0-or-later
"""Messages that reach Blender's status bar fit it, and do not end with a full stop. Read from the sources."""

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LENGTH = 80  # characters
NAME = "#" * 8  # for each part that is only known later
ERRORS = {"InputError", "ValueError", "SceneChangedError", "DragEnded"}


def text_of(node: ast.expr) -> str:
    """A text with a usual name for each of its unknown parts."""
    if isinstance(node, ast.Constant):
        return str(node.value)
    if isinstance(node, ast.JoinedStr):
        return "".join(text_of(each) if isinstance(each, ast.Constant) else NAME for each in node.values)
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add):
        return text_of(node.left) + text_of(node.right)
    if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "translate":
        return text_of(node.args[0]).replace("{}", NAME)
    if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "format":
        return text_of(node.func.value).replace("{}", NAME)  # type: ignore[attr-defined]
    return NAME


def messages() -> Iterator[tuple[str, str]]:
    """The place and the text of every error and report of the add-on and of stiv.blender."""
    for folder in ("addon", "python/stiv/blender"):
        for path in sorted((ROOT / folder).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if not isinstance(node, ast.Call):
                    continue
                name = getattr(node.func, "id", getattr(node.func, "attr", ""))
                for text in node.args[:1] if name in ERRORS else node.args[1:2] if name == "report" else []:
                    yield f"{path.relative_to(ROOT)}:{node.lineno}", text_of(text)


def test_every_message_fits_the_status_bar() -> None:
    found = dict(messages())
    assert len(found) > 80
    long = {place: text for place, text in found.items() if len(text) > LENGTH}
    assert not long


def test_no_message_ends_with_a_full_stop_or_begins_with_the_word_object() -> None:
    for place, text in messages():
        assert not text.endswith("."), place
        assert not text.startswith('object "'), place
