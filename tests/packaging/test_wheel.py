# SPDX-License-Identifier: GPL-3.0-or-later
"""Contents of the installed wheel and the source archive."""

import importlib.metadata
import shutil
import tarfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def installed_files() -> set[str]:
    try:
        files = importlib.metadata.files("stiv")
    except importlib.metadata.PackageNotFoundError:
        pytest.skip("stiv is not installed as a wheel")
    return {file.as_posix() for file in files or []}


def test_wheel_contains_every_module_of_the_package(installed_files: set[str]) -> None:
    sources = {path.relative_to(ROOT / "python").as_posix() for path in (ROOT / "python").rglob("*.py")}
    assert sources
    assert sources <= installed_files
    assert "stiv/py.typed" in installed_files


def test_wheel_contains_the_scene_of_the_demo(installed_files: set[str]) -> None:
    assert installed_files >= {"stiv/demo/plant_in_vase.blend", "stiv/demo/plant_in_vase.edits.json"}


def test_wheel_contains_the_addon_as_a_package(installed_files: set[str]) -> None:
    sources = {f"stiv_addon/{path.relative_to(ROOT / 'addon').as_posix()}" for path in (ROOT / "addon").rglob("*.py")}
    assert sources
    assert sources <= installed_files


def test_wheel_contains_the_licenses_of_linked_libraries(installed_files: set[str]) -> None:
    names = {Path(name).name for name in installed_files if "/licenses/" in name}
    assert names >= {"LICENSE", "Eigen.txt", "Highway.txt", "OpenSubdiv.txt", "OpenSubdiv-NOTICE.txt", "pybind11.txt"}


@pytest.fixture
def copied_tree(tmp_path: Path) -> Path:
    """A copy of the source tree with a build folder.

    In the real tree, the backend's search for files may enter `build/` although it is ignored, and follow
    links of a mounted Debian folder out of the tree.
    """
    tree = tmp_path / "tree"
    shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns("build", "dist", ".git", "__pycache__", ".*_cache"))
    for name in ("build/native/log.txt", "dist/stiv.zip", "python/stiv/_native.so"):
        path = tree / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("built")
    return tree


def needed_for_a_build() -> set[str]:
    """Names of the files that compiling and installing read."""
    folders = ("cmake", "licenses", "native/bindings", "native/include", "native/src", "python", "addon")
    sources = {path for folder in folders for path in (ROOT / folder).rglob("*") if path.is_file()}
    kept = {path for path in sources if not {"__pycache__", "examples"} & set(path.parts) and path.suffix != ".so"}
    names = {path.relative_to(ROOT).as_posix() for path in kept}
    scripts = {"tools/opensubdiv_source.sh", "tools/private_apt.sh"}
    demo = {"blend_fixtures/plant_in_vase.blend", "blend_fixtures/plant_in_vase.edits.json"}
    return (
        names | scripts | demo | {"CMakeLists.txt", "native/CMakeLists.txt", "pyproject.toml", "LICENSE", "README.md"}
    )


def test_source_archive_contains_everything_that_a_build_needs(
    copied_tree: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    backend = pytest.importorskip("scikit_build_core.build", reason="the build backend is in build/venv only")
    monkeypatch.chdir(copied_tree)
    with tarfile.open(tmp_path / backend.build_sdist(str(tmp_path))) as archive:
        names = {name.split("/", 1)[1] for name in archive.getnames() if "/" in name}
    assert not needed_for_a_build() - names
    assert not any(
        name.startswith(("build/", "dist/", "docs/films/", "tests/")) or name.endswith(".so") for name in names
    )


def test_wheel_contains_no_measurements(installed_files: set[str]) -> None:
    names = {Path(name).stem for name in installed_files if name.startswith("stiv/")}
    measured = {path.stem for path in (ROOT / "benchmarks/sessions").glob("*.py")} - {"__init__"}
    assert names & measured == set()
    assert not any(name.startswith(("stiv/scenes", "benchmarks", "blend_fixtures")) for name in installed_files)
