# SPDX-License-Identifier: GPL-3.0-or-later
"""The zip, installed into a Blender without the source tree, registers and finds its own wheel."""

import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")

from tools import install_extension  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
INSTALL_SCRIPT = Path(__file__).with_name("install_extension.py")


@pytest.fixture(scope="module")
def extension(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The zip under test from `make`, or else one built from the wheel of this tree."""
    named = ROOT / "build/extension"
    if sys.platform == "win32":
        return next((ROOT / "build/windows").glob("stiv-*-windows_x64.zip"))
    if named.is_file():
        return ROOT / named.read_text().strip()
    wheels = sorted((ROOT / "build/wheel").glob("*.whl"))
    if not wheels:
        pytest.skip("no wheel in build/wheel")
    from tools import build_extension

    (archive,) = build_extension.build(wheels, tmp_path_factory.mktemp("dist"))
    return archive


def site_packages_without_stiv(folder: Path) -> Path:
    """The packages of this environment except stiv, which must come from the zip."""
    if sys.platform == "win32":
        return Path(sysconfig.get_path("purelib"))  # install_extension.py left no stiv in it
    for entry in Path(sysconfig.get_path("purelib")).iterdir():
        if not entry.name.startswith("stiv"):
            (folder / entry.name).symlink_to(entry)
    return folder


def test_zip_passes_blenders_own_validation(extension: Path) -> None:
    run = subprocess.run(install_extension.validation(extension), capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr


# Below each: a user's home, resources and temporary files
USERS = ["user", "山田 太郎 ü", str(Path(*["long folder ü " + 48 * str(number) for number in range(5)]))]


@pytest.mark.parametrize("user", USERS, ids=["plain", "japanese", "long"])
def test_installed_zip_registers_and_uses_its_own_core(extension: Path, tmp_path: Path, user: str) -> None:
    packages, home = tmp_path / "packages", tmp_path / user
    long = user == USERS[-1]
    temporary = tmp_path if long else home / "Temp"  # Windows allows none of more than 260 characters
    for folder in (packages, home / "Temp"):
        folder.mkdir(parents=True)
    assert not long or len(str(home)) > 260
    environment = {
        **os.environ,
        **dict.fromkeys(("TEMP", "TMP", "TMPDIR"), str(temporary)),
        "PYTHONPATH": str(site_packages_without_stiv(packages)),
        "BLENDER_USER_RESOURCES": str(home / "blender"),
        "HOME": str(home),
        "USERPROFILE": str(home),
        "PYTHONIOENCODING": "utf-8",
    }
    python = getattr(sys, "_base_executable", sys.executable)
    command = [python, "-S", INSTALL_SCRIPT, extension, home / "blender"]
    run = subprocess.run(
        command, env=environment, capture_output=True, encoding="utf-8", errors="replace", timeout=300, check=False
    )
    assert run.returncode == 0, run.stdout + run.stderr
