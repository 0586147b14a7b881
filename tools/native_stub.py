# SPDX-License-Identifier: GPL-3.0-or-later
"""Write python/stiv/_native.pyi from the compiled module: pybind11-stubgen's stub, made short and fit for
mypy.

Usage: native_stub.py, with a Python that has STIV, pybind11-stubgen and ruff. A test compares the file with
the module.
"""

import ast
import enum
import importlib
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
STUB = ROOT / "python/stiv/_native.pyi"
COMMENT = "# SPDX-License-Identifier: GPL-3.0-or-later\n# Written by tools/native_stub.py.\n"
HEAD = """
from collections.abc import Sequence
from enum import Enum
from typing import Annotated, Any

from numpy import float32, float64, int32
from numpy.typing import ArrayLike, NDArray

class InputError(ValueError): ...
class InfeasibleError(InputError): ...
class CancelledError(RuntimeError): ...
class StartIntersectsError(InputError):
    pairs: NDArray[int32]
"""  # the module makes the exceptions at run time, as names of `stiv`
NAMES = {"typing.SupportsInt": "int", "typing.SupportsFloat": "float"}  # others lose the name of their module
CONTAINERS = {"dict": "dict[str, Any]", "tuple": "tuple[Any, ...]"}


def stub_text() -> str:
    """The stub of the module that this Python imports, formatted."""
    tree = Shortened().visit(ast.parse(generated()))
    text = COMMENT + ast.unparse(ast.fix_missing_locations(tree))
    return ruff("format", ruff("check", text, "--fix", "--select", "I"))


def ruff(what: str, text: str, *options: str) -> str:
    """The stub after a command of ruff."""
    command = [sys.executable, "-m", "ruff", what, "--quiet", *options, "--stdin-filename", STUB, "-"]
    return subprocess.run(command, cwd=ROOT, input=text, capture_output=True, text=True, check=True).stdout


def generated() -> str:
    """The stub as pybind11-stubgen writes it."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "pybind11_stubgen", "stiv._native", "--exit-code", "-o", folder]
        subprocess.run(command, check=True, capture_output=True)
        return (Path(folder) / "stiv/_native.pyi").read_text(encoding="utf-8")


class Shortened(ast.NodeTransformer):
    """Members for enums, attributes for properties with a setter, plain numbers and optional arguments."""

    def visit_Module(self, node: ast.Module) -> ast.Module:
        """The classes and functions alone, below HEAD."""
        documentation, *statements = node.body
        definitions = [self.visit(each) for each in statements if isinstance(each, ast.ClassDef | ast.FunctionDef)]
        node.body = [documentation, *ast.parse(HEAD).body, *definitions]
        return node

    def visit_ClassDef(self, node: ast.ClassDef) -> ast.ClassDef:
        """An enum by its members in order; attributes first, then methods."""
        if [ast.unparse(base) for base in node.bases] == ["enum.Enum"]:
            members: type[enum.Enum] = getattr(importlib.import_module("stiv._native"), node.name)
            node.bases, lines = [ast.Name("Enum")], [f"{each.name} = {each.value}" for each in members]
            node.body = ast.parse("\n".join(lines)).body
            return node
        setters = {each.name: attribute_of(each) for each in node.body if is_setter(each)}
        methods = [each for each in node.body if isinstance(each, ast.FunctionDef) and each.name not in setters]
        fields = [each for each in node.body if not isinstance(each, ast.FunctionDef)]
        node.body = [*fields, *setters.values(), *methods]
        self.generic_visit(node)
        return node

    def visit_FunctionDef(self, node: ast.FunctionDef) -> ast.FunctionDef:
        """Arguments that are None by default are optional; containers of anything say so."""
        self.generic_visit(node)
        arguments = node.args.args
        with_default = arguments[len(arguments) - len(node.args.defaults) :]
        for argument, default in zip(with_default, node.args.defaults, strict=True):
            kind = ast.unparse(argument.annotation)
            if ast.unparse(default) == "None" and "None" not in kind and kind != "Any":
                argument.annotation = expression(f"{kind} | None")
        if node.returns is not None:
            node.returns = expression(CONTAINERS.get(ast.unparse(node.returns), ast.unparse(node.returns)))
        return node

    def visit_arg(self, node: ast.arg) -> ast.arg:
        """An array is given for a list of numbers."""
        self.generic_visit(node)
        if node.annotation is not None and ast.unparse(node.annotation) in ("Sequence[int]", "Sequence[float]"):
            node.annotation = expression("ArrayLike")
        return node

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        """A number without `typing.SupportsIndex`."""
        if ast.unparse(node.right) == "typing.SupportsIndex":
            return self.visit(node.left)
        self.generic_visit(node)
        return node

    def visit_Attribute(self, node: ast.Attribute) -> ast.expr:
        """Names as HEAD imports them."""
        return ast.Name(NAMES.get(ast.unparse(node), node.attr))

    def visit_Subscript(self, node: ast.Subscript) -> ast.Subscript:
        """Shapes alone; how arrays lie in memory is checked at run time."""
        self.generic_visit(node)
        if isinstance(node.slice, ast.Tuple):
            node.slice.elts = [each for each in node.slice.elts if ast.unparse(each) != "'flags.c_contiguous'"]
        return node


def is_setter(node: ast.stmt) -> bool:
    """Whether a statement is the setter of a property."""
    return isinstance(node, ast.FunctionDef) and any(
        ast.unparse(each).endswith(".setter") for each in node.decorator_list
    )


def attribute_of(setter: ast.FunctionDef) -> ast.AnnAssign:
    """The attribute that a setter sets."""
    return ast.AnnAssign(ast.Name(setter.name), setter.args.args[1].annotation, None, simple=1)


def expression(text: str) -> ast.expr:
    """The expression in a text."""
    return ast.parse(text, mode="eval").body


if __name__ == "__main__":
    STUB.write_text(stub_text(), encoding="utf-8")
