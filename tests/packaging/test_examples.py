# SPDX-License-Identifier: GPL-3.0-or-later
"""Every example in every document runs exactly as printed, with the wheel installed by pip, in a subprocess.

Python blocks run as scripts, or as tests if they use the fixture of the pytest plugin. Command lines run in a
shell, in the folder of their files.
"""

import os
import re
import shlex
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from stiv.command_line.program import parser

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTS = {path.stem: path.read_text(encoding="utf-8") for path in [ROOT / "README.md", *ROOT.glob("docs/*.md")]}
SCRIPT = re.compile(r"^```python\n(.*?)^```", re.DOTALL | re.MULTILINE)
COMMAND = re.compile(r"^    (stiv .*)$", re.MULTILINE)
INLINE = re.compile(r"`stiv ([^`]+)`")
SCRIPTS = [(name, block) for name, text in DOCUMENTS.items() for block in SCRIPT.findall(text)]
COMMANDS = {name: found for name, text in DOCUMENTS.items() if (found := COMMAND.findall(text))}
PLACEHOLDERS = {"K/N": "1/2", "A:B": "1:2"}

WRITTEN = {
    "animation": ["resolved.blend", "frames.json", "clean.blend"],
    "batch": ["report.json", "out/vase.blend", "out/walk.blend", "out/cow.blend", "out/cow.json", "out/assets.json"],
    "checks": ["checks.xml", "checks.json"],
    "edit_scripts": ["OUT.blend"],
    "gallery": ["OUT.blend"],
    "repair": ["repaired.blend", "report.json", "repaired.obj"],
}
PRINTED = {
    "README": [r"corrected \d+ 0"],
    "scripting": [
        r"corrected \[.*\] \(0\.99\d+, .*\)",
        r"(corrected|budget) True 0\nTrue \(.*\) 0\.99\d+",
        r"done \('Cube',\) 1\.01",
        r"corrected",
        r"corrected 0 True",
        r"corrected 0 True",
    ],
    "checks": [r"1 passed"],
}
ONE_BLENDER = Path(sys.prefix).resolve() == (ROOT / "build/venv-blender").resolve()  # the Blender of the demo
needs_blender = pytest.mark.skipif(find_spec("bpy") is None, reason="needs Blender as a Python module (bpy)")
once = pytest.mark.skipif(not ONE_BLENDER, reason="commands of documents are run with the demo's Blender only")


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The environment of a user with only the wheel and its dependencies."""
    wheels = sorted(ROOT.glob("build/wheel/stiv-*.whl"))
    if not wheels:
        pytest.skip("no wheel in build/wheel")
    site = tmp_path_factory.mktemp("site")
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--no-index"]
    subprocess.run([*pip, "--target", site, wheels[-1]], check=True)
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    environment |= {"PYTHONPATH": str(site), "PATH": f"{site / 'bin'}{os.pathsep}{os.environ['PATH']}"}
    used = run([sys.executable, "-c", "import stiv; print(stiv.__file__)"], site, environment)
    assert Path(used.strip()).is_relative_to(site)
    return environment


def run(command: list[str], folder: Path, environment: dict[str, str]) -> str:
    """Standard output of a process that must succeed."""
    ended = subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=300
    )
    assert ended.returncode == 0, f"{shlex.join(command)}: {ended.returncode}\n{ended.stdout}{ended.stderr}"
    return ended.stdout


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory, installed: dict[str, str]) -> Path:
    """The files that the examples use."""
    made = tmp_path_factory.mktemp("files")
    run([sys.executable, str(Path(__file__).with_name("example_files.py")), str(ROOT / "docs")], made, installed)
    return made


@pytest.fixture
def folder(tmp_path: Path, files: Path) -> Path:
    """A copy of these files."""
    return shutil.copytree(files, tmp_path / "here", symlinks=True)


def expected(number: int) -> str:
    """The expected output of a script."""
    name, _ = SCRIPTS[number]
    return PRINTED[name][[each for each, _ in SCRIPTS[:number]].count(name)]


@pytest.mark.parametrize("number", [number for number, (name, _) in enumerate(SCRIPTS) if name == "README"])
def test_scripts_without_blender(number: int, installed: dict[str, str], tmp_path: Path) -> None:
    run_script(number, tmp_path, installed)


@pytest.mark.blender
@needs_blender
@pytest.mark.parametrize("number", [number for number, (name, _) in enumerate(SCRIPTS) if name != "README"])
def test_scripts_with_blender(number: int, installed: dict[str, str], folder: Path) -> None:
    run_script(number, folder, installed)


def run_script(number: int, folder: Path, environment: dict[str, str]) -> None:
    name, script = SCRIPTS[number]
    file = folder / f"test_{name}.py"
    file.write_text(script, encoding="utf-8")
    runner = ["-m", "pytest", "-q", "-p", "no:cacheprovider"] if "def test_" in script else []
    assert re.search(expected(number), run([sys.executable, *runner, str(file)], folder, environment))


@pytest.mark.blender
@needs_blender
@once
@pytest.mark.parametrize("name", COMMANDS)
def test_commands(name: str, installed: dict[str, str], folder: Path) -> None:
    run_commands(name, COMMANDS[name], folder, installed)


@pytest.mark.blender
@needs_blender
@once
def test_commands_within_the_text(installed: dict[str, str], folder: Path) -> None:
    """Run the commands of the README that name files; they use SCENE.blend, which starts clear."""
    run_commands("edit_scripts", ["stiv replay SCENE.blend EDITS.json -o OUT.blend"], folder, installed)
    commands = [f"stiv {found}" for found in INLINE.findall(DOCUMENTS["README"]) if "SCENE.blend" in found]
    assert len(commands) == 2
    run(["sh", "-ec", "\n".join(commands)], folder, installed)


def run_commands(name: str, commands: list[str], folder: Path, environment: dict[str, str]) -> None:
    run(["sh", "-ec", "\n".join(commands)], folder, environment)
    missing = [each for each in WRITTEN[name] if not (folder / each).is_file()]
    assert not missing
    free = [each for each in WRITTEN[name] if each.endswith((".blend", ".obj"))]
    if free:
        run(["stiv", "check", *free], folder, environment)


def test_every_command_within_the_text_is_valid() -> None:
    for name, text in DOCUMENTS.items():
        for found in INLINE.findall(text):
            words = shlex.split(re.sub("|".join(PLACEHOLDERS), lambda match: PLACEHOLDERS[match[0]], found))
            if len(words) > 1 and "--help" not in words:
                assert parser().parse_args(words), name


def test_every_example_runs() -> None:
    assert {name for name, _ in SCRIPTS} == PRINTED.keys()
    assert COMMANDS.keys() | {"edit_scripts"} == WRITTEN.keys()
