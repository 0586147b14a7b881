# SPDX-License-Identifier: GPL-3.0-or-later
"""Build stiv-<version>.zip, the add-on as a Blender extension with the wheels given.

Usage: build_extension.py FOLDER WHEEL...   one wheel a version of Python; Blender unpacks the one that fits.
"""

import sys
import tomllib
import zipfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import build_guide

ROOT = Path(__file__).resolve().parent.parent
ADDON = ROOT / "addon"
EMPTY_WHEELS = "wheels = []\n"
FIRST_DATE = (1980, 1, 1, 0, 0, 0)


def project_version() -> str:
    """Version of the project, the one place where it is written down."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    return str(project["version"])


def filled_manifest(wheels: list[Path]) -> str:
    """The add-on's manifest with its empty list of wheels filled in; checks that its version is the project's."""
    text = (ADDON / "blender_manifest.toml").read_text()
    if text.count(EMPTY_WHEELS) != 1:
        raise SystemExit(f"addon/blender_manifest.toml: needs exactly one line {EMPTY_WHEELS.strip()!r}")
    version = tomllib.loads(text)["version"]
    if version != project_version():
        raise SystemExit(f"addon/blender_manifest.toml: version {version}, but the project's is {project_version()}")
    names = "".join(f'  "./wheels/{wheel.name}",\n' for wheel in wheels)
    return text.replace(EMPTY_WHEELS, f"wheels = [\n{names}]\n")


def contents(wheels: list[Path]) -> dict[str, bytes]:
    """Every file of the extension by its name in the archive."""
    files = {"blender_manifest.toml": filled_manifest(wheels).encode(), "LICENSE": (ROOT / "LICENSE").read_bytes()}
    for source in ADDON.rglob("*.py"):
        files[source.relative_to(ADDON).as_posix()] = source.read_bytes()
    for text in (ROOT / "licenses").iterdir():
        files[f"licenses/{text.name}"] = text.read_bytes()
    for name, data in build_guide.files().items():
        files[f"guide/{name}"] = data
    for wheel in wheels:
        files[f"wheels/{wheel.name}"] = wheel.read_bytes()
    return files


def build(wheels: list[Path], folder: Path) -> Path:
    """Write the archive into a folder; the same input gives the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / f"stiv-{project_version()}.zip"
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in sorted(contents(wheels).items()):
            entry = zipfile.ZipInfo(name, FIRST_DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
    return target


if __name__ == "__main__":
    if len(sys.argv) < 3:
        raise SystemExit("build_extension.py: name a folder and at least one wheel")
    print(build([Path(argument) for argument in sys.argv[2:]], Path(sys.argv[1])))
