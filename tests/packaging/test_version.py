# SPDX-License-Identifier: GPL-3.0-or-later
"""Only pyproject.toml contains the version; CMake and the extension's manifest read it from there."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from tools import build_extension

ROOT = Path(__file__).resolve().parents[2]
VERSION = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]


def test_cmake_reads_it(tmp_path: Path) -> None:
    script = tmp_path / "version.cmake"
    script.write_text('include(cmake/project_version.cmake)\nmessage("is ${STIV_VERSION}")\n')
    ran = subprocess.run(["cmake", "-P", script], cwd=ROOT, capture_output=True, text=True)
    if ran.returncode:
        pytest.fail(ran.stderr)
    assert f"is {VERSION}\n" in ran.stderr


def test_the_manifest_in_the_zip_has_it() -> None:
    name = "stiv-1-cp311-cp311-win_amd64.whl"
    manifest = tomllib.loads(build_extension.filled_manifest([Path(name)]))
    assert manifest["version"] == VERSION
    assert manifest["wheels"] == [f"./wheels/{name}"]
    assert manifest["platforms"] == ["windows-x64"]


def test_a_manifest_with_a_version_of_its_own_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "blender_manifest.toml").write_text('version = "9.9.9"\nplatforms = []\nwheels = []\n')
    monkeypatch.setattr(build_extension, "ADDON", tmp_path)
    with pytest.raises(SystemExit, match=re.escape('version = "0.0.0"')):
        build_extension.filled_manifest([])


@pytest.mark.parametrize("name", ["CMakeLists.txt", "addon/blender_manifest.toml", "CITATION.cff", "docs/Doxyfile"])
def test_no_other_file_repeats_it(name: str) -> None:
    text = (ROOT / name).read_text().replace('schema_version = "1.0.0"', "")  # of Blender's manifests
    assert VERSION not in text


def test_the_changelog_has_a_section_for_it() -> None:
    assert f"\n## [{VERSION}] - " in (ROOT / "CHANGELOG.md").read_text()
