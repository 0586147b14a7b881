# SPDX-License-Identifier: GPL-3.0-or-later
"""Lists every text of the add-on's interface that Blender can translate, from the sources.

These are names and descriptions of properties and of their choices, labels and tooltips of operators, labels of panels
and menus, constant texts of layouts, arguments of `translate` and `counted`, values of dictionaries named ..._TEXTS.
"""

import ast
from collections.abc import Iterator
from pathlib import Path

ADDON = Path(__file__).resolve().parent.parent / "addon"
LAYOUT_CALLS = {"label", "operator", "prop", "menu", "prop_search", "prop_enum"}


def messages(folder: Path = ADDON) -> set[str]:
    """All texts in the sources of a folder."""
    trees = [ast.parse(path.read_text()) for path in sorted(folder.rglob("*.py")) if "translations" not in path.parts]
    return {text for tree in trees for node in ast.walk(tree) for text in _of(node) if any(map(str.isalpha, text))}


def _of(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.Call):
        yield from _of_call(node)
    elif isinstance(node, ast.ClassDef):
        yield from _of_class(node)
    elif isinstance(node, ast.Assign) and isinstance(node.value, ast.Tuple):
        yield from _of_choices(node.value)
    elif (
        isinstance(node, ast.Assign)
        and isinstance(node.value, ast.Dict)
        and ast.unparse(node.targets[0]).endswith("_TEXTS")
    ):
        for value in node.value.values:
            yield from _constants(value)


def _of_call(node: ast.Call) -> Iterator[str]:
    name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
    for argument in {"translate": node.args[:1], "counted": node.args[1:]}.get(name, []):
        yield from _constants(argument)
    wanted = {"name", "description"} if name.endswith("Property") else {"text"} if name in LAYOUT_CALLS else set()
    for keyword in node.keywords:
        if keyword.arg in wanted:
            yield from _constants(keyword.value)


def _of_class(node: ast.ClassDef) -> Iterator[str]:
    values = {
        target.id: item.value
        for item in node.body if isinstance(item, ast.Assign)
        for target in item.targets if isinstance(target, ast.Name)
    }  # fmt: skip
    if "bl_label" in values:
        yield from _constants(values["bl_label"])
    if "bl_description" in values:
        yield from _constants(values["bl_description"])
    elif node.name.startswith(("STIV_OT_", "STIV_MT_")):
        yield ast.get_docstring(node) or ""


def _of_choices(node: ast.Tuple) -> Iterator[str]:
    """Name and description of each choice of an enumeration: triples of constants."""
    for item in node.elts:
        if isinstance(item, ast.Tuple) and len(item.elts) >= 3:
            texts = [each.value for each in item.elts[:3] if isinstance(each, ast.Constant)]
            if len(texts) == 3 and all(isinstance(text, str) for text in texts):
                yield from texts[1:]


def _constants(node: ast.expr) -> Iterator[str]:
    """A constant, or both of a choice between two."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, ast.IfExp):
        yield from _constants(node.body)
        yield from _constants(node.orelse)


if __name__ == "__main__":
    print("\n".join(sorted(messages())))
