# SPDX-License-Identifier: GPL-3.0-or-later
"""Make a wheel for every Python version that the extension supports.

Usage: portable_wheels.py WHEEL FOLDER PLATFORM MODULE...

WHEEL is the wheel of this source tree, for any Python; each MODULE replaces its module in one of the new
wheels. They replace those for PLATFORM in FOLDER and are tagged for it: manylinux_2_17_x86_64 if the modules are
compiled for that version of the C library, linux_x86_64 if they are for systems like this one. The wheels
differ only in module and tag. The zips contain the same wheels as PyPI, so these also contain the add-on and the
demo, which scripts and commands use.
"""

import base64
import hashlib
import re
import sys
import zipfile
from pathlib import Path

MODULE = "stiv/_native."
FIRST_DATE = (1980, 1, 1, 0, 0, 0)


def python_tag(module: Path) -> str:
    """Tag of the Python version in a module's name: "cp313"."""
    found = re.fullmatch(r"_native\.(?:cpython-(\d+)-(?:\w+-linux-gnu|darwin)\.so|cp(\d+)-win_\w+\.pyd)", module.name)
    if found is None:
        raise SystemExit(f"{module}: not the name of a native module")
    return f"cp{found[1] or found[2]}"


def read_wheel(path: Path) -> dict[str, bytes]:
    """Files of a wheel by name, without its native module and the list of files."""
    with zipfile.ZipFile(path) as archive:
        names = [name for name in archive.namelist() if not name.endswith(("/", "/RECORD"))]
        return {name: archive.read(name) for name in names if not name.startswith(MODULE)}


def with_module(files: dict[str, bytes], module: Path, tag: str) -> dict[str, bytes]:
    """The same files with this module and tag, and a matching list of files."""
    (description,) = [name for name in files if name.endswith(".dist-info/WHEEL")]
    text = files[description].decode()
    if len(re.findall(r"^Tag: .*$", text, re.MULTILINE)) != 1:
        raise SystemExit(f"{description}: needs exactly one tag")
    retagged = re.sub(r"^Tag: .*$", f"Tag: {tag}", text, flags=re.MULTILINE)
    result = files | {description: retagged.encode(), f"stiv/{module.name}": module.read_bytes()}
    record = str(Path(description).with_name("RECORD"))
    lines = [f"{name},sha256={digest(data)},{len(data)}" for name, data in sorted(result.items())]
    return result | {record: "\n".join([*lines, f"{record},,", ""]).encode()}


def digest(data: bytes) -> str:
    """Hash of a file in the format of the list of files."""
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def write_wheel(path: Path, files: dict[str, bytes]) -> None:
    """Write a wheel; the same files give the same bytes."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in sorted(files.items()):
            entry = zipfile.ZipInfo(name, FIRST_DATE)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, data)


def main(wheel: Path, folder: Path, platform: str, modules: list[Path]) -> None:
    """Write all wheels."""
    files = read_wheel(wheel)
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob(f"*-{platform}.whl"):
        old.unlink()
    name = "-".join(wheel.name.split("-")[:2])
    for module in modules:
        python = python_tag(module)
        tag = f"{python}-{python}-{platform}"
        write_wheel(folder / f"{name}-{tag}.whl", with_module(files, module, tag))


if __name__ == "__main__":
    if len(sys.argv) < 5:
        raise SystemExit("portable_wheels.py: name a wheel, a folder, a platform and at least one module")
    wheel, folder, platform, *modules = sys.argv[1:]
    main(Path(wheel), Path(folder), platform, [Path(module) for module in modules])
