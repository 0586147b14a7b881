# SPDX-License-Identifier: GPL-3.0-or-later
"""The extension follows the rules of docs/publishing.md: its manifest, and every source that it reaches."""

import ast
import re
import sys
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path

import pytest

from tools import build_extension

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "python"
ADDON = ROOT / "addon"
RULES = (ROOT / "docs/publishing.md").read_text(encoding="utf-8")
MANIFEST = tomllib.loads(build_extension.filled_manifest([]))
LONGEST_TAGLINE = 64  # of the platform, also for the reasons of permissions

THREADS = {"threading", "_thread", "concurrent", "multiprocessing", "asyncio", "queue"}
PROCESSES = {"subprocess", "pty", "signal"}
NETWORK = {"socket", "ssl", "http", "urllib", "ftplib", "smtplib", "xmlrpc", "webbrowser", "requests", "distributed"}
CODE_FROM_TEXT = {"eval", "exec", "compile", "__import__", "runpy", "pickle"}
IMPORT_PATHS = {"sys.path", "sys.path_hooks", "sys.meta_path", "site.addsitedir", "sys.modules"}
OS_CALLS = {"os.system", "os.popen", "os.fork", "os.putenv", "os.environ", "os._exit", "os.kill", "os.execv"}
WRITING = {"write_text", "write_bytes", "mkdir", "makedirs", "unlink", "rename", "rmdir", "rmtree", "symlink_to"}
WRITING |= {
    "touch",
    "remove_file",
    "copyfile",
    "copytree",
    "mkstemp",
    "mkdtemp",
    "NamedTemporaryFile",
    "savez",
    "tofile",
}
READ_ONLY = {"sys.modules.get"}
FROM_BLENDER = {"bpy", "bpy_extras", "blf", "bmesh", "gpu", "gpu_extras", "mathutils", "rna_keymap_ui", "numpy"}


def module_file(name: str) -> Path | None:
    """The source of a module of the package."""
    path = PACKAGE.joinpath(*name.split("."))
    found = [file for file in (path / "__init__.py", path.with_suffix(".py")) if file.is_file()]
    return found[0] if found else None


def imported(tree: ast.AST) -> Iterator[str]:
    """Absolute imports, at any depth, and names of modules in texts, for `import_module`."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield from (node.module, *(f"{node.module}.{alias.name}" for alias in node.names))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield from re.findall(r"^stiv(?:\.\w+)+$", node.value)


def reached(start: Iterable[Path]) -> dict[Path, ast.AST]:
    """The add-on's sources, and each module of the package that these import, directly or not."""
    trees = dict[Path, ast.AST]()
    todo = list(start)
    while todo:
        path = todo.pop()
        if path not in trees:
            trees[path] = ast.parse(path.read_text(encoding="utf-8"))
            parts = [name.split(".") for name in imported(trees[path]) if name.split(".")[0] == "stiv"]
            modules = [".".join(name[:end]) for name in parts for end in range(1, len(name) + 1)]
            todo += [file for name in modules if (file := module_file(name))]
    return trees


REACHED = reached(ADDON.rglob("*.py"))


def forbidden_imports(tree: ast.AST, names: set[str]) -> list[str]:
    """Imports of these packages."""
    return [name for name in imported(tree) if name.split(".")[0] in names]


def forbidden_names(tree: ast.AST, names: set[str]) -> list[str]:
    """Uses of these functions, plain ("eval"), of a module ("os.system") or of any object (".mkdir")."""
    nodes = [node for node in ast.walk(tree) if isinstance(node, ast.Attribute | ast.Name)]
    exempt = [node.value for node in nodes if isinstance(node, ast.Attribute) and dotted(node) in READ_ONLY]
    return [text for node in nodes if (text := dotted(node)) in names and node not in exempt]


def dotted(node: ast.expr) -> str:
    """A name such as "sys.path"; of other expressions only the last part."""
    if isinstance(node, ast.Attribute):
        return f"{dotted(node.value)}.{node.attr}"
    return node.id if isinstance(node, ast.Name) else ""


def writing_calls(tree: ast.AST) -> list[str]:
    """Calls that write files: `open` for anything but reading, and functions and methods that write."""
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    return [ast.unparse(node) for node in calls if opens_for_writing(node) or called(node) in WRITING]


def called(node: ast.Call) -> str:
    """The last part of a function's name."""
    return node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")


def opens_for_writing(node: ast.Call) -> bool:
    """Is it `open` with a mode that may write?"""
    modes = [part.value for part in [*node.args, *(word.value for word in node.keywords)] if is_mode(part)]
    return called(node) == "open" and any(set(mode) & set("wax+") for mode in modes)


def is_mode(node: ast.expr) -> bool:
    """Is it a constant such as "wb"?"""
    return isinstance(node, ast.Constant) and isinstance(node.value, str) and set(node.value) <= set("rwaxbt+")


def places(check: Iterable[tuple[Path, list[str]]]) -> list[str]:
    """Findings with their files."""
    return [f"{path.relative_to(ROOT)}: {found}" for path, found in check if found]


def test_the_scan_reaches_the_whole_addon_and_its_package_but_no_command() -> None:
    assert set(ADDON.rglob("*.py")) <= set(REACHED)
    assert PACKAGE / "stiv/blender/edit/blender_edit.py" in REACHED
    assert PACKAGE / "stiv/self_test.py" in REACHED
    assert not [path for path in REACHED if {"command_line", "batch"} & set(path.parts)]


@pytest.mark.parametrize("names", [THREADS, PROCESSES, NETWORK], ids=["threads", "processes", "network"])
def test_no_reached_source_imports(names: set[str]) -> None:
    assert not places((path, forbidden_imports(tree, names)) for path, tree in REACHED.items())


@pytest.mark.parametrize(
    "names", [CODE_FROM_TEXT, IMPORT_PATHS, OS_CALLS], ids=["code from text", "import paths", "system calls"]
)
def test_no_reached_source_uses(names: set[str]) -> None:
    assert not places((path, forbidden_names(tree, names)) for path, tree in REACHED.items())


def test_no_reached_source_writes_files() -> None:
    assert not places((path, writing_calls(tree)) for path, tree in REACHED.items())


def test_every_import_is_in_the_standard_library_in_blender_or_in_the_package() -> None:
    known = sys.stdlib_module_names | FROM_BLENDER | {"stiv", "stiv_addon"}
    assert not places(
        (path, [name for name in imported(tree) if name.split(".")[0] not in known]) for path, tree in REACHED.items()
    )


def test_the_addon_imports_its_own_modules_relatively() -> None:
    assert not places(
        (path, forbidden_imports(tree, {"addon", "stiv_addon", "bl_ext"}))
        for path, tree in REACHED.items()
        if ADDON in path.parents
    )


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ("import os.path, threading", [1, 0, 0]),
        ("def f():\n    from concurrent.futures import Future", [2, 0, 0]),
        ("eval('1')", [0, 1, 0]),
        ("import sys\nsys.path.append('x')", [0, 1, 0]),
        ("import sys\nsys.modules['x'] = 1", [0, 1, 0]),
        ("import sys\nsys.modules.get('x')", [0, 0, 0]),
        ("import sys\nsys.modules.get('x')\ndel sys.modules['x']", [0, 1, 0]),
        ("import os\nos.environ['A'] = 'b'", [0, 1, 0]),
        ("open('x', mode='w')", [0, 0, 1]),
        ("path.open('ab')", [0, 0, 1]),
        ("path.open('rb'); open(name)", [0, 0, 0]),
        ("Path('x').write_text('y')", [0, 0, 1]),
        ("importlib.import_module('stiv.batch.run')", [0, 0, 0]),
    ],
)
def test_the_scan_finds_each_violation(source: str, found: list[int]) -> None:
    tree = ast.parse(source)
    names = CODE_FROM_TEXT | IMPORT_PATHS | OS_CALLS
    checks = (forbidden_imports(tree, THREADS), forbidden_names(tree, names), writing_calls(tree))
    assert [len(check) for check in checks] == found


def test_modules_named_in_texts_are_reached(tmp_path: Path) -> None:
    source = tmp_path / "lazy.py"
    source.write_text("import importlib\nimportlib.import_module('stiv.batch.run')\n")
    assert PACKAGE / "stiv/batch/run.py" in reached([source])


def test_the_manifest_is_short_honest_and_without_blenders_name() -> None:
    reasons = MANIFEST["permissions"]
    for text in (MANIFEST["tagline"], *reasons.values()):
        assert len(text) <= LONGEST_TAGLINE and text[-1].isalnum()
    assert reasons.keys() == {"files", "clipboard"}  # neither network nor camera nor microphone
    for field in ("id", "name", "tagline"):
        assert "blender" not in MANIFEST[field].lower()
    assert MANIFEST["license"] == ["SPDX:GPL-3.0-or-later"]
    assert MANIFEST["blender_version_min"] == "4.2.0"


def test_the_manifest_credits_every_library_with_a_license() -> None:
    credits = " ".join(MANIFEST["copyright"])
    libraries = {path.stem.partition("-")[0] for path in (ROOT / "licenses").glob("*.txt")}
    assert libraries
    assert not [name for name in libraries if name not in credits]


def test_the_zip_contains_no_byte_code_and_nothing_hidden() -> None:
    names = list(build_extension.contents([]))
    assert "__init__.py" in names and "LICENSE" in names
    assert not [name for name in names if name.endswith((".pyc", ".pyo", ".so", ".pyd", ".exe")) or "/." in f"/{name}"]


def test_every_public_function_of_the_addon_has_type_hints() -> None:
    functions = [
        (path, node)
        for path, tree in REACHED.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")
    ]
    assert len(functions) > 500
    assert not [f"{path.relative_to(ROOT)}: {node.name}" for path, node in functions if node.returns is None]


def test_every_rule_names_a_test_that_exists() -> None:
    rows = [line for line in RULES.splitlines() if line.startswith("| ") and not line.startswith(("| rule", "|--"))]
    named = [(row, re.findall(r"`(tests/[\w/]+\.py)(?:::(\w+))?`", row)) for row in rows]
    assert len(rows) >= 20
    assert not [row for row, found in named if not found]
    for _, found in named:
        for file, test in found:
            assert f"def {test}" in (ROOT / file).read_text(encoding="utf-8"), f"{file} has no {test}"
