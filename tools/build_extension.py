# SPDX-License-Identifier: GPL-3.0-or-later
"""Build stiv-<version>-<platform>.zip, the add-on as a Blender extension, for each platform of the given wheels.

Usage: build_extension.py FOLDER WHEEL...   one wheel per platform and version of Python; Blender unpacks the matching
one. The names are those that Blender's own `extension build --split-platforms` gives.
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
NO_PLATFORMS = "platforms = []\n"
NO_VERSION = 'version = "0.0.0"\n'
FIRST_DATE = (1980, 1, 1, 0, 0, 0)


def project_version() -> str:
    """Version of the project, from the only place that contains it."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    return str(project["version"])


def platform_names() -> dict[str, str]:
    """Blender's names of platforms by the tags of wheels, with those of a wheel for this system."""
    rows = [line.split() for line in (ROOT / "tools/platforms.txt").read_text().splitlines() if line[:1].isalpha()]
    return {"linux_x86_64": "linux-x64", "linux_aarch64": "linux-arm64"} | {row[5]: row[0] for row in rows}


def platform_of(wheel: Path) -> str:
    """The platform of a wheel, as Blender calls it."""
    tag = wheel.stem.split("-")[-1]
    if tag not in platform_names():
        raise SystemExit(f"{wheel.name}: tools/platforms.txt has no platform with the tag {tag}")
    return platform_names()[tag]


def filled_manifest(wheels: list[Path]) -> str:
    """The add-on's manifest with the project's version, the wheels and their platforms."""
    names = "".join(f'  "./wheels/{wheel.name}",\n' for wheel in wheels)
    text = (ADDON / "blender_manifest.toml").read_text()
    text = replace_line(text, NO_VERSION, f'version = "{project_version()}"\n')
    platforms = ", ".join(f'"{platform}"' for platform in sorted({platform_of(wheel) for wheel in wheels}))
    text = replace_line(text, NO_PLATFORMS, f"platforms = [{platforms}]\n")
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


def build(wheels: list[Path], folder: Path) -> list[Path]:
    """Write an archive for each platform into a folder; the same input gives the same bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    built = []
    for platform in sorted({platform_of(wheel) for wheel in wheels}):
        built.append(folder / f"stiv-{project_version()}-{platform.replace('-', '_')}.zip")
        write_archive(built[-1], contents([wheel for wheel in wheels if platform_of(wheel) == platform]))
    return built


def write_archive(target: Path, files: dict[str, bytes]) -> None:
    """Write a zip with fixed dates, in the order of the names."""
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in sorted(files.items()):
            entry = zipfile.ZipInfo(name, FIRST_DATE)
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        raise SystemExit("build_extension.py: name a folder and at least one wheel")
    print(*build([Path(argument) for argument in sys.argv[2:]], Path(sys.argv[1])), sep="\n")
