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
    if named.is_file():
        return ROOT / named.read_text().strip()
    wheels = sorted((ROOT / "build/wheel").glob("*.whl"))
    if not wheels:
        pytest.skip("no wheel in build/wheel")
    from tools import build_extension

    (archive,) = build_extension.build(wheels, tmp_path_factory.mktemp("dist"))
    return archive


def site_packages_without_stiv(folder: Path) -> Path:
    """Links to all packages of this environment except stiv, which must come from the zip."""
    for entry in Path(sysconfig.get_path("purelib")).iterdir():
        if not entry.name.startswith("stiv"):
            (folder / entry.name).symlink_to(entry)
    return folder


def test_zip_passes_blenders_own_validation(extension: Path) -> None:
    run = subprocess.run(install_extension.validation(extension), capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr


def test_installed_zip_registers_and_uses_its_own_core(extension: Path, tmp_path: Path) -> None:
    packages = tmp_path / "packages"
    packages.mkdir()
    environment = {
        **os.environ,
        "PYTHONPATH": str(site_packages_without_stiv(packages)),
        "BLENDER_USER_RESOURCES": str(tmp_path / "blender"),
        "HOME": str(tmp_path),
    }
    python = getattr(sys, "_base_executable", sys.executable)
    command = [python, "-S", INSTALL_SCRIPT, extension, tmp_path / "blender"]
    run = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
