# SPDX-License-Identifier: GPL-3.0-or-later
"""The wheels in the extension's zip: portable, complete, and with the same bits as the tested core."""

import csv
import hashlib
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from modules import exported_names, needed_libraries, newest_glibc

from tools import portable_wheels

ROOT = Path(__file__).resolve().parents[2]
NAMED = ROOT / "build/extension-all"  # written by `make extension`
C_LIBRARY = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "ld-linux-x86-64.so.2"}
OLDEST = (2, 17)


@pytest.fixture(scope="module")
def wheels(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """The unpacked wheels of the zip."""
    if not NAMED.is_file():
        pytest.skip("the extension was not built for all Pythons (make extension)")
    folder = tmp_path_factory.mktemp("zip")
    with zipfile.ZipFile(ROOT / NAMED.read_text().strip()) as archive:
        archive.extractall(folder)
    return sorted((folder / "wheels").glob("*.whl"))


def unpacked(wheel: Path, folder: Path) -> Path:
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def test_there_is_a_wheel_for_this_python_and_each_matches_its_module(wheels: list[Path], tmp_path: Path) -> None:
    tags = {wheel.name.split("-")[2] for wheel in wheels}
    assert f"cp{sys.version_info.major}{sys.version_info.minor}" in tags
    for wheel in wheels:
        (module,) = unpacked(wheel, tmp_path / wheel.name).glob("stiv/_native*.so")
        assert portable_wheels.python_tag(module) == wheel.name.split("-")[2]


def test_modules_need_only_an_old_c_library(wheels: list[Path], tmp_path: Path) -> None:
    for wheel in wheels:
        (module,) = unpacked(wheel, tmp_path / wheel.name).glob("stiv/_native*.so")
        assert exported_names(module) == {"PyInit__native"}
        assert needed_libraries(module) <= C_LIBRARY
        assert newest_glibc(module) <= OLDEST


def test_the_list_of_files_of_each_wheel_is_right(wheels: list[Path]) -> None:
    for wheel in wheels:
        with zipfile.ZipFile(wheel) as archive:
            (record,) = [name for name in archive.namelist() if name.endswith(".dist-info/RECORD")]
            listed = {row[0]: row[1] for row in csv.reader(archive.read(record).decode().splitlines())}
            assert listed.keys() == set(archive.namelist())
            for name, digest in listed.items():
                assert name == record or digest == f"sha256={portable_wheels.digest(archive.read(name))}"
            assert {"stiv_addon/__init__.py", "stiv/demo/plant_in_vase.blend"} <= listed.keys()


EDIT = """
import hashlib, sys
import numpy as np
import stiv

def grid(n, z, tilt):
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n), indexing="ij")
    k = np.arange(n * n).reshape(n, n)
    a, b, c, d = k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return np.stack([x, y, z + tilt * x * y], -1).reshape(-1, 3), faces

upper, faces = grid(24, 0.5, 0.3)
lower, _ = grid(24, -0.1, -0.2)
start = np.concatenate([upper, lower])
triangles = np.concatenate([faces, faces + len(upper)]).astype(np.int32)
goal = start.copy()
goal[: len(upper), 2] -= 1.0
print(stiv.__file__, file=sys.stderr)
result = stiv.edit(triangles, stiv.identity(len(start)), start, goal)
assert result.status == "corrected", result.status
digest = hashlib.sha256(np.ascontiguousarray(result.controls).tobytes()).hexdigest()
print(digest, result.rounds, len(result.events.kind))
"""


def run(folder: Path | None) -> str:
    """Digest of an edit's result, with the package of a folder or the installed one."""
    environment = os.environ | ({"PYTHONPATH": str(folder)} if folder else {})
    done = subprocess.run(
        [sys.executable, "-c", EDIT], env=environment, capture_output=True, text=True, check=True, timeout=300
    )
    assert folder is None or str(folder) in done.stderr
    return done.stdout


def test_an_edit_gives_the_same_bits_as_the_tested_module(wheels: list[Path], tmp_path: Path) -> None:
    tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
    (wheel,) = [wheel for wheel in wheels if wheel.name.split("-")[2] == tag]
    assert run(unpacked(wheel, tmp_path / "wheel")) == run(None)


def made_wheel(folder: Path) -> Path:
    path = folder / "stiv-9.9-cp311-cp311-linux_x86_64.whl"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("stiv/__init__.py", "")
        archive.writestr("stiv/_native.cpython-311-x86_64-linux-gnu.so", b"old")
        archive.writestr("stiv_addon/__init__.py", "")
        archive.writestr("stiv-9.9.dist-info/WHEEL", "Wheel-Version: 1.0\nTag: cp311-cp311-linux_x86_64\n")
        archive.writestr("stiv-9.9.dist-info/RECORD", "")
    return path


def test_a_module_replaces_the_one_in_a_wheel(tmp_path: Path) -> None:
    module = tmp_path / "_native.cpython-313-x86_64-linux-gnu.so"
    module.write_bytes(b"new")
    portable_wheels.main(made_wheel(tmp_path), tmp_path / "out", "manylinux_2_17_x86_64", [module])
    (made,) = (tmp_path / "out").iterdir()
    assert made.name == "stiv-9.9-cp313-cp313-manylinux_2_17_x86_64.whl"
    with zipfile.ZipFile(made) as archive:
        assert archive.read(f"stiv/{module.name}") == b"new"
        assert "stiv/_native.cpython-311-x86_64-linux-gnu.so" not in archive.namelist()
        assert "stiv_addon/__init__.py" in archive.namelist()  # the published wheel, unmodified
        assert b"Tag: cp313-cp313-manylinux_2_17_x86_64\n" in archive.read("stiv-9.9.dist-info/WHEEL")
    first = hashlib.sha256(made.read_bytes()).digest()
    portable_wheels.main(made_wheel(tmp_path), tmp_path / "out", "manylinux_2_17_x86_64", [module])
    assert hashlib.sha256(made.read_bytes()).digest() == first


def test_other_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match="not the name"):
        portable_wheels.python_tag(tmp_path / "_native.so")
