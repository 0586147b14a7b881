# SPDX-License-Identifier: GPL-3.0-or-later
"""Build stiv-<version>.zip, the add-on as a Blender extension with the given wheels.

Usage: build_extension.py FOLDER WHEEL...   one wheel per version of Python; Blender unpacks the matching one.
"""

import sys
import tomllib
import zipfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import build_guide

ROOT = Path(__file__).resolve().parent.parent
ADDON = ROOT / "addon"
EXAMPLES = ROOT / "blend_fixtures" / "examples"
EMPTY_WHEELS = "wheels = []\n"
NO_VERSION = 'version = "0.0.0"\n'
FIRST_DATE = (1980, 1, 1, 0, 0, 0)


def project_version() -> str:
    """Version of the project, from the only place that contains it."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    return str(project["version"])


def filled_manifest(wheels: list[Path]) -> str:
    """The add-on's manifest with the project's version and the list of wheels."""
    names = "".join(f'  "./wheels/{wheel.name}",\n' for wheel in wheels)
    text = (ADDON / "blender_manifest.toml").read_text()
    text = replace_line(text, NO_VERSION, f'version = "{project_version()}"\n')
    return replace_line(text, EMPTY_WHEELS, f"wheels = [\n{names}]\n")


def replace_line(manifest: str, placeholder: str, line: str) -> str:
    """The manifest with a placeholder replaced, which must be a line of its own."""
    if f"\n{manifest}".count(f"\n{placeholder}") != 1:
        raise SystemExit(f"addon/blender_manifest.toml: needs exactly one line {placeholder.strip()!r}")
    return f"\n{manifest}".replace(f"\n{placeholder}", f"\n{line}")[1:]


def contents(wheels: list[Path]) -> dict[str, bytes]:
    """All files of the extension by their names in the archive."""
    files = {"blender_manifest.toml": filled_manifest(wheels).encode(), "LICENSE": (ROOT / "LICENSE").read_bytes()}
    for source in ADDON.rglob("*.py"):
        files[source.relative_to(ADDON).as_posix()] = source.read_bytes()
    for text in (ROOT / "licenses").iterdir():
        files[f"licenses/{text.name}"] = text.read_bytes()
    for name, data in build_guide.files().items():
        files[f"guide/{name}"] = data
    for example in EXAMPLES.iterdir():
        files[f"examples/{example.name}"] = example.read_bytes()
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
