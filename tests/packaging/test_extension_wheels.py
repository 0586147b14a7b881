# SPDX-License-Identifier: GPL-3.0-or-later
"""The wheels in the extension's zips: portable, complete, and with the same bits as the tested core."""

import csv
import hashlib
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from modules import (
    exported_names,
    fused_operations,
    imported_names,
    inexact_functions,
    libraries_by_delocate,
    mac_module,
    needed_libraries,
    newest_glibc,
    oldest_tags,
    windows_interface,
)

from tools import portable_wheels

ROOT = Path(__file__).resolve().parents[2]
NAMED = ROOT / "build/extension-all"  # written by `make extension`
C_LIBRARY = {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2"}
LOADERS = {"ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
OLDEST = (2, 17)


@pytest.fixture(scope="module")
def all_wheels(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """The unpacked wheels of all zips, each in a folder named after its zip."""
    if not NAMED.is_file():
        pytest.skip("the extension was not built for all Pythons (make extension)")
    folder = tmp_path_factory.mktemp("zips")
    for name in NAMED.read_text().split():
        with zipfile.ZipFile(ROOT / name) as archive:
            archive.extractall(folder / Path(name).stem)
    return sorted(folder.glob("*/wheels/*.whl"))


@pytest.fixture
def wheels(all_wheels: list[Path]) -> list[Path]:
    """Those for this system."""
    return [wheel for wheel in all_wheels if wheel.stem.endswith("manylinux_2_17_x86_64")]


def unpacked(wheel: Path, folder: Path) -> Path:
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def test_there_is_a_wheel_for_this_python_and_each_matches_its_module(wheels: list[Path], tmp_path: Path) -> None:
    tags = {wheel.name.split("-")[2] for wheel in wheels}
    assert f"cp{sys.version_info.major}{sys.version_info.minor}" in tags
    for wheel in wheels:
        module = module_of(wheel, tmp_path)
        assert portable_wheels.python_tag(module) == wheel.name.split("-")[2]


def module_of(wheel: Path, folder: Path) -> Path:
    (module,) = unpacked(wheel, folder / wheel.name).glob("stiv/_native.*")
    return module


def test_modules_need_only_an_old_c_library(all_wheels: list[Path], tmp_path: Path) -> None:
    for wheel in [wheel for wheel in all_wheels if "manylinux_2_17" in wheel.name]:
        module = module_of(wheel, tmp_path)
        assert exported_names(module) == {"PyInit__native"}
        assert needed_libraries(module) <= C_LIBRARY | LOADERS
        assert newest_glibc(module) <= OLDEST
        assert not inexact_functions(imported_names(module))


def test_windows_modules_export_only_their_entry_and_need_windows_10(all_wheels: list[Path], tmp_path: Path) -> None:
    for wheel in [wheel for wheel in all_wheels if wheel.stem.endswith("win_amd64")]:
        exported, libraries = windows_interface(module_of(wheel, tmp_path))
        assert exported == {"PyInit__native"}
        python = f"python{wheel.name.split('-')[2].removeprefix('cp')}.dll"
        own = {name for name in libraries if not name.startswith("api-ms-win-crt-")}  # the universal C runtime
        assert own == {python, "KERNEL32.dll"}


def test_macos_modules_export_only_their_entry_and_need_macos_11(all_wheels: list[Path], tmp_path: Path) -> None:
    for wheel in [wheel for wheel in all_wheels if "macosx_11_0" in wheel.name]:
        module = mac_module(module_of(wheel, tmp_path))
        assert module.processor == ("ARM64" if wheel.stem.endswith("arm64") else "X86_64")
        assert module.exported == {"_PyInit__native"}
        assert module.libraries == {"/usr/lib/libSystem.B.dylib"}
        assert module.oldest[:2] == (11, 0)
        assert module.signed or module.processor == "X86_64"  # arm64 loads only signed modules
        assert "_nextafter" in module.imported and not inexact_functions(module.imported)
        assert not [name for name in module.merged if name.startswith(("__Zn", "__Zd"))]  # operators new and delete


def test_modules_for_arm64_round_every_product(all_wheels: list[Path], tmp_path: Path) -> None:
    for wheel in [wheel for wheel in all_wheels if wheel.stem.endswith(("arm64", "aarch64"))]:
        assert fused_operations(module_of(wheel, tmp_path)) == 0


def test_paths_of_files_are_short_enough_for_windows(all_wheels: list[Path]) -> None:
    below = r"C:\Users\twenty letters no more\AppData\Roaming\Blender Foundation\Blender\4.5\extensions"
    packages = r"\.local\lib\python3.11\site-packages"
    compiled = r"\__pycache__\.cpython-311.pyc.1234567890123"  # Python's temporary names are the longest
    for wheel in all_wheels:
        with zipfile.ZipFile(wheel) as archive:
            longest = max(map(len, archive.namelist()))
        assert len(below + packages + compiled) + 1 + longest < 260


def test_auditwheel_and_delocate_find_the_systems_that_the_tags_name(all_wheels: list[Path], tmp_path: Path) -> None:
    for wheel in all_wheels:
        tag = wheel.stem.split("-")[-1]
        if tag.startswith("manylinux"):
            (oldest,) = oldest_tags(wheel)
            assert oldest.split("_", 3)[3] == tag.split("_", 3)[3]
            assert int(oldest.split("_")[2]) <= OLDEST[1]
        elif tag.startswith("macosx"):
            assert libraries_by_delocate(wheel, tmp_path / wheel.name) == {"/usr/lib/libSystem.B.dylib"}


def test_each_zip_has_the_wheels_of_its_platform_only(all_wheels: list[Path]) -> None:
    rows = [line.split() for line in (ROOT / "tools/platforms.txt").read_text().splitlines() if line[:1].isalpha()]
    expected = {row[0].replace("-", "_"): {f"cp{v.replace('.', '')}-{row[5]}" for v in row[6:]} for row in rows}
    for folder in {wheel.parents[1] for wheel in all_wheels}:
        tags = {wheel.stem.split("-", 3)[3] for wheel in all_wheels if wheel.parents[1] == folder}
        assert tags == expected[folder.name.split("-")[-1]]


def test_the_list_of_files_of_each_wheel_is_right(all_wheels: list[Path]) -> None:
    for wheel in all_wheels:
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
print(digest, result.rounds, len(result.events.kind), stiv.self_test().vectors)
"""


def run(folder: Path | None) -> str:
    """Digest of an edit's result, with the package of a folder or the installed one."""
    environment = os.environ | ({"PYTHONPATH": str(folder)} if folder else {})
    done = subprocess.run(
        [sys.executable, "-c", EDIT], env=environment, capture_output=True, text=True, check=True, timeout=300
    )
    assert folder is None or str(folder) in done.stderr
    return done.stdout


def test_an_edit_gives_the_same_bits_with_the_same_vectors_as_the_tested_module(
    wheels: list[Path], tmp_path: Path
) -> None:
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


@pytest.mark.parametrize("name", ["cpython-313-aarch64-linux-gnu.so", "cpython-313-darwin.so", "cp313-win_amd64.pyd"])
def test_the_version_of_a_module_is_in_its_name_on_every_platform(name: str) -> None:
    assert portable_wheels.python_tag(Path(f"_native.{name}")) == "cp313"


def test_other_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(SystemExit, match="not the name"):
        portable_wheels.python_tag(tmp_path / "_native.so")
