# SPDX-License-Identifier: GPL-3.0-or-later
"""Validate the extension's zips with the validators of all releases of Blender in blender_versions.toml.

Usage: validate_extension.py FOLDER ZIP...   FOLDER: where validators are stored that no environment in build has

Each comes from the Blender module of its release, and runs without Blender. PyPI has these modules, of hundreds of
megabytes; of a release that it does not have, nothing is validated, and the last line says so.
"""

import subprocess
import sys
import tempfile
import tomllib
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VALIDATOR = "scripts/addons_core/bl_pkg/cli/blender_ext.py"
TAGS = "scripts/modules/_bpy_internal/extensions/tags.py"


def releases() -> dict[str, str]:
    """The Python version of each release of Blender."""
    table = tomllib.loads((ROOT / "tools/blender_versions.toml").read_text(encoding="utf-8"))
    return {release: python for python, row in table.items() for release in row["blender"]}


def scripts_of(release: str, python: str, folder: Path) -> Path | None:
    """The folder with the validator of a release: installed, stored, or downloaded; none if PyPI does not have it."""
    stored = folder / release
    for place in (*(ROOT / f"build/venv-blender-{release}").glob("lib/*/site-packages"), stored):
        for validator in place.glob(f"bpy/*/{VALIDATOR}"):
            return validator.parents[4]
    with tempfile.TemporaryDirectory() as downloads:
        pip = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
        choice = ["--only-binary=:all:", "--platform", "manylinux_2_28_x86_64", "--python-version", python]
        if subprocess.run([*pip, *choice, "--dest", downloads, f"bpy=={release}"], check=False).returncode:
            return None
        (wheel,) = Path(downloads).iterdir()
        with zipfile.ZipFile(wheel) as files:
            files.extractall(stored, [name for name in files.namelist() if name.endswith((VALIDATOR, TAGS))])
    return next(stored.glob("bpy/*"))


def main(folder: Path, archives: list[Path]) -> int:
    """The number of releases that refuse a zip."""
    taken, refused, absent = [], [], []
    for release, python in releases().items():
        scripts = scripts_of(release, python, folder)
        if scripts is None:
            absent.append(release)
            continue
        command = [sys.executable, scripts / VALIDATOR, "validate", "--valid-tags", scripts / TAGS]
        runs = [subprocess.run([*command, archive], check=False, stdout=subprocess.DEVNULL) for archive in archives]
        (refused if any(run.returncode for run in runs) else taken).append(release)
    print(f"{len(archives)} zips, accepted by the validators of Blender {', '.join(taken) or 'none'}", end="")
    print(f"; refused by {', '.join(refused)}" if refused else "", end="")
    print(f"; not validated, because PyPI has no module: {', '.join(absent)}" if absent else "")
    return len(refused)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        raise SystemExit("validate_extension.py: name a folder and at least one zip")
    raise SystemExit(main(Path(sys.argv[1]), [Path(name) for name in sys.argv[2:]]))
