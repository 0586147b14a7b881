# SPDX-License-Identifier: GPL-3.0-or-later
"""Collect the pages of the documentation site in a folder with the layout of the repository.

Usage: site_pages.py FOLDER [CPP]   CPP: Doxygen's folder of HTML

The documents stay as they are, so that their links work in the repository and on the site. Pages of the reference
name the public objects of a package, whose docstrings mkdocstrings inserts.
"""

import ast
import shutil
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DOCUMENTS = ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "CITATION.cff", "LICENSE")
FOLDERS = {
    "docs": (".md",),
    "docs/images": (".png",),
    "docs/films": (".webm",),
    "docs/gallery": (".png", ".webp"),
    "benchmarks/results/quality": (".png",),
}
OTHERS = ("benchmarks/results/README.md", "tests/README.md")
KATEX = Path("/usr/share/javascript/katex")  # Debian's package libjs-katex
PACKAGES = {
    "stiv": "The core for NumPy arrays, without Blender. [Scripting](../docs/scripting.md) has examples.",
    "stiv.blender": "Edits, checks and layouts of Blender's scenes; the only package that imports `bpy`.",
}


def documents() -> list[str]:
    """Names of all documents, pictures and films."""
    in_folders = [
        path.relative_to(ROOT).as_posix()
        for folder, endings in FOLDERS.items()
        for path in sorted((ROOT / folder).iterdir())
        if path.suffix in endings
    ]
    return [*DOCUMENTS, *in_folders, *OTHERS]


def public_names(package: str) -> list[str]:
    """The names in a package's `__all__`, from its source."""
    source = (ROOT / "python").joinpath(*package.split("."), "__init__.py").read_text(encoding="utf-8")
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return [str(name) for name in ast.literal_eval(node.value)]
    raise SystemExit(f"{package} has no __all__")


def reference(package: str) -> str:
    """A page of the reference: functions first, then classes and constants."""
    names = sorted(public_names(package), key=lambda name: (not name[0].islower(), name.lower()))
    objects = "\n\n".join(f"::: {path_of(package, name)}" for name in names)
    return f"# {package}\n\n{PACKAGES[package]}\n\n{objects}\n"


def path_of(package: str, name: str) -> str:
    """Path of a public object. A function with the name of its module is named within the module."""
    module = (ROOT / "python").joinpath(*package.split("."), f"{name}.py")
    return f"{package}.{name}.{name}" if module.is_file() else f"{package}.{name}"


def write(target: Path, data: bytes) -> None:
    """Write a file unless it has this content, so that a rebuild sees what has changed."""
    target.parent.mkdir(parents=True, exist_ok=True)
    if not target.is_file() or target.read_bytes() != data:
        target.write_bytes(data)


def collect(folder: Path, cpp: Path | None = None) -> None:
    """Write all pages and their assets into a folder."""
    for name in documents():
        write(folder / name, (ROOT / name).read_bytes())
    for package in PACKAGES:
        write(folder / "api" / f"{package.replace('.', '_')}.md", reference(package).encode())
    for name in ("math.js", "site.css"):
        write(folder / "assets" / name, (ROOT / "docs/site" / name).read_bytes())
    if cpp:
        shutil.copytree(cpp, folder / "cpp", dirs_exist_ok=True)
    if KATEX.is_dir():
        for name in ("katex.min.js", "katex.min.css"):
            write(folder / "assets/katex" / name, (KATEX / name).read_bytes())
        shutil.copytree(KATEX / "fonts", folder / "assets/katex/fonts", dirs_exist_ok=True)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        raise SystemExit("site_pages.py: name a folder")
    collect(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None)
