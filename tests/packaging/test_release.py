# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder of a release: the same wheels for the extension platform and PyPI, notes and hashes; the workflow."""

import re
import shutil
import subprocess
import zipfile
from pathlib import Path
from typing import Any

import pytest
import yaml

from tools import build_extension, release

ROOT = Path(__file__).resolve().parents[2]
WORKFLOW = ROOT / ".github/workflows/release.yml"
LOG = "# Changelog\n\n## [Unreleased]\n\n## [9.1.0] - 2027-01-01\n\n- new\n\n## [9.0.0] - 2026-01-01\n\n- old\n"
PLATFORMS = {"linux_x64": "manylinux_2_17_x86_64", "windows_x64": "win_amd64"}


def wheel(folder: Path, tag: str, *names: str) -> Path:
    path = folder / f"stiv-9.1.0-cp311-cp311-{tag}.whl"
    with zipfile.ZipFile(path, "w") as files:
        for name in names:
            files.writestr(name, tag)
    return path


def zipped(folder: Path, platform: str, *wheels: Path, version: str = "9.1.0") -> None:
    names = ", ".join(f'"./wheels/{each.name}"' for each in wheels)
    with zipfile.ZipFile(folder / f"stiv-9.1.0-{platform}.zip", "w") as files:
        files.writestr("blender_manifest.toml", f'version = "{version}"\nwheels = [{names}]\n')
        for each in wheels:
            files.write(each, f"wheels/{each.name}")


@pytest.fixture
def built(tmp_path: Path) -> Path:
    """Made files as `make release` builds them, for two platforms."""
    folder = tmp_path / "dist"
    folder.mkdir()
    for platform, tag in PLATFORMS.items():
        zipped(folder, platform, wheel(folder, tag, *release.COMPLETE, "stiv/_native.x.so"))
    (folder / "stiv-9.1.0.tar.gz").write_text("sources")
    return folder


def test_a_release_is_complete_and_its_hashes_are_right(built: Path, tmp_path: Path) -> None:
    folder = tmp_path / "release"
    release.collect(built, folder, "9.1.0", LOG)
    assert len(list((folder / "extension").glob("*.zip"))) == len(PLATFORMS)
    assert {path.name for path in (folder / "pypi").iterdir()} == {
        "stiv-9.1.0.tar.gz", *(f"stiv-9.1.0-cp311-cp311-{tag}.whl" for tag in PLATFORMS.values()),
    }  # fmt: skip
    assert (folder / "NOTES.md").read_text() == "## [9.1.0] - 2027-01-01\n\n- new\n"
    subprocess.run(["sha256sum", "--check", "--quiet", "SHA256SUMS"], cwd=folder, check=True)
    assert len((folder / "SHA256SUMS").read_text().splitlines()) == 2 * len(PLATFORMS) + 2


def test_a_wheel_that_differs_from_the_published_one_is_refused(built: Path, tmp_path: Path) -> None:
    wheel(built, "win_amd64", *release.COMPLETE, "stiv/_native.other.so")
    with pytest.raises(SystemExit, match="must have the same file"):
        release.collect(built, tmp_path / "release", "9.1.0", LOG)
    assert not (tmp_path / "release").exists()


@pytest.mark.parametrize("names", [release.COMPLETE, ("stiv/__init__.py", "stiv/_native.x.so")])
def test_an_incomplete_wheel_is_refused(built: Path, tmp_path: Path, names: tuple[str, ...]) -> None:
    zipped(built, "linux_x64", wheel(built, "manylinux_2_17_x86_64", *names))
    with pytest.raises(SystemExit, match="is incomplete"):
        release.collect(built, tmp_path / "release", "9.1.0", LOG)


def test_files_of_another_version_and_missing_notes_are_refused(built: Path, tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match=r"no section \[9.1.0\]"):
        release.collect(built, tmp_path / "release", "9.1.0", "# Changelog\n")
    with pytest.raises(SystemExit, match=r"needs stiv-8\.0\.0"):
        release.collect(built, tmp_path / "release", "8.0.0", LOG)
    zipped(built, "linux_x64", version="0.0.0")
    with pytest.raises(SystemExit, match=r"not of version 9\.1\.0"):
        release.collect(built, tmp_path / "release", "9.1.0", LOG)


def test_the_changelog_has_notes_for_this_version() -> None:
    text = release.notes(build_extension.project_version(), (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))
    assert len(text.splitlines()) > 5


@pytest.fixture(scope="module")
def workflow() -> dict[str, Any]:
    return dict(yaml.safe_load(WORKFLOW.read_text(encoding="utf-8")))


def steps(workflow: dict[str, Any]) -> list[dict[str, Any]]:
    return [step for job in workflow["jobs"].values() for step in job["steps"]]


def test_the_workflow_says_that_nobody_has_run_it() -> None:
    assert "has not been run" in WORKFLOW.read_text(encoding="utf-8").split("\nname:")[0]


def test_the_workflow_has_known_keys_and_jobs(workflow: dict[str, Any]) -> None:
    assert workflow.keys() == {"name", True, "permissions", "jobs"}  # YAML reads "on" as true
    for job in workflow["jobs"].values():
        assert job.keys() <= {"name", "needs", "if", "runs-on", "container", "strategy", "permissions", "environment",
                              "defaults", "steps"}  # fmt: skip
        needed = job.get("needs", [])
        assert {needed} if isinstance(needed, str) else set(needed) <= workflow["jobs"].keys()
    for step in steps(workflow):
        assert step.keys() <= {"name", "if", "uses", "with", "run", "env", "shell"}
        assert ("uses" in step) != ("run" in step)
        assert "uses" not in step or re.fullmatch(r"[\w-]+/[\w/-]+@[\w./-]+", step["uses"])


def test_the_scripts_of_the_workflow_are_valid_and_name_existing_targets_and_files(workflow: dict[str, Any]) -> None:
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    scripts = [re.sub(r"\$\{\{.*?\}\}", "VALUE", step["run"]) for step in steps(workflow) if "run" in step]
    assert scripts
    for script in scripts:
        subprocess.run([shutil.which("bash") or "sh", "-n", "-c", script], check=True)
        assert set(re.findall(r"^make ([a-z-]+)", script, re.MULTILINE)) <= targets
        for name in re.findall(r"\b(?:tools|tests)/[\w./]+", script):
            assert (ROOT / name).exists(), name


def test_every_expression_of_the_workflow_names_a_value_that_exists(workflow: dict[str, Any]) -> None:
    for name, job in workflow["jobs"].items():
        matrix = job.get("strategy", {}).get("matrix", {})
        values = set(matrix) | {key for row in matrix.get("include", []) for key in row}
        used = set(re.findall(r"\$\{\{ *matrix\.(\w+) *\}\}", yaml.safe_dump(job)))
        assert used <= values, name
        assert set(re.findall(r"\$\{\{ *(\w+)\.", yaml.safe_dump(job))) <= {"matrix", "github", "secrets", "runner"}
