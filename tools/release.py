# SPDX-License-Identifier: GPL-3.0-or-later
"""Collect a release in a folder that is ready for upload.

Usage: release.py BUILT FOLDER   BUILT: the folder with the zips, the source archive and, if built, plain wheels

    FOLDER/extension   a zip for each platform, for Blender's extension platform
    FOLDER/pypi        the wheels of these zips, unmodified, and the source archive
    FOLDER/NOTES.md    the section of the changelog
    FOLDER/SHA256SUMS  a hash of each file, for sha256sum --check
"""

import hashlib
import re
import shutil
import sys
import tomllib
import zipfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from build_extension import ROOT, project_version

COMPLETE = ("stiv/__init__.py", "stiv_addon/__init__.py", "stiv/demo/plant_in_vase.blend")


def wheels_of(archive: Path, version: str) -> dict[str, bytes]:
    """Wheels of a zip by name. The zip and its wheels must have the version of the project."""
    with zipfile.ZipFile(archive) as files:
        manifest = tomllib.loads(files.read("blender_manifest.toml").decode())
        wheels = {Path(name).name: files.read(name.removeprefix("./")) for name in manifest["wheels"]}
    if manifest["version"] != version or not all(name.startswith(f"stiv-{version}-") for name in wheels):
        raise SystemExit(f"{archive.name} is not of version {version}; build it again")
    return wheels


def check_complete(wheel: Path) -> None:
    """Refuse a wheel without the add-on, the demo, or one native module."""
    with zipfile.ZipFile(wheel) as files:
        names = files.namelist()
    modules = [name for name in names if re.fullmatch(r"stiv/_native\..*\.(so|pyd)", name)]
    if len(modules) != 1 or not set(COMPLETE) <= set(names):
        raise SystemExit(f"{wheel.name} is incomplete: it needs one native module, and {', '.join(COMPLETE)}")


def notes(version: str, changelog: str) -> str:
    """The changelog's section of a version."""
    found = re.search(rf"^## \[{re.escape(version)}\].*?(?=^## \[|\Z)", changelog, re.MULTILINE | re.DOTALL)
    if found is None:
        raise SystemExit(f"CHANGELOG.md has no section [{version}]")
    return found[0].strip() + "\n"


def hashes(folder: Path) -> str:
    """A line for each file of a folder, in the format of sha256sum."""
    files = sorted(path for path in folder.rglob("*") if path.is_file() and path.name != "SHA256SUMS")
    lines = [
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.relative_to(folder).as_posix()}" for path in files
    ]
    return "\n".join(lines) + "\n"


def collect(built: Path, folder: Path, version: str, changelog: str) -> None:
    """Check and copy everything. The folder is complete or absent."""
    partial = folder.with_name(f"{folder.name}.partial")
    shutil.rmtree(partial, ignore_errors=True)
    for name in ("extension", "pypi"):
        (partial / name).mkdir(parents=True)
    archives = sorted(built.glob(f"stiv-{version}*.zip"))
    sources = built / f"stiv-{version}.tar.gz"
    if not archives or not sources.is_file():
        raise SystemExit(f"{built} needs stiv-{version}*.zip and {sources.name}")
    for archive in archives:
        shutil.copy2(archive, partial / "extension")
        for name, data in wheels_of(archive, version).items():
            if (built / name).is_file() and (built / name).read_bytes() != data:
                raise SystemExit(
                    f"{archive.name} contains another {name} than {built}; the zip must have the same file"
                )
            (partial / "pypi" / name).write_bytes(data)
            check_complete(partial / "pypi" / name)
    shutil.copy2(sources, partial / "pypi")
    (partial / "NOTES.md").write_text(notes(version, changelog), encoding="utf-8")
    (partial / "SHA256SUMS").write_text(hashes(partial), encoding="utf-8")
    shutil.rmtree(folder, ignore_errors=True)
    partial.rename(folder)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit("release.py: name the folder of the built files and a folder to write")
    collect(
        Path(sys.argv[1]), Path(sys.argv[2]), project_version(), (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    )
    print((Path(sys.argv[2]) / "SHA256SUMS").read_text(), end="")
