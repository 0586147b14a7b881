# SPDX-License-Identifier: GPL-3.0-or-later
"""The Windows Python of `make test-windows`: its known hash, and what PyPI does not have."""

import subprocess
from pathlib import Path

import pytest

from tools import windows_python


def test_an_archive_with_another_hash_is_an_error_and_no_reason_to_skip(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(windows_python, "downloaded", lambda _: b"something else")
    with pytest.raises(SystemExit, match="another hash"):
        windows_python.main("3.11", tmp_path / "python", [])
    assert not (tmp_path / "python").exists()


def test_packages_that_pip_cannot_install_end_with_the_code_for_skipping(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "python.exe").touch()
    commands: list[list[str]] = []

    def run(command: list[str], check: bool) -> subprocess.CompletedProcess[bytes]:
        commands.append(command)
        return subprocess.CompletedProcess(command, "bpy==9.9" in command)

    monkeypatch.setattr(windows_python.subprocess, "run", run)
    windows_python.main("3.13", tmp_path, ["pytest"])
    assert [command[-1] for command in commands] == ["pytest", windows_python.NUMPY["3.13"]]
    with pytest.raises(SystemExit) as ended:
        windows_python.main("3.13", tmp_path, ["bpy==9.9"])
    assert ended.value.code == windows_python.UNAVAILABLE
    assert "pip cannot install bpy==9.9" in capsys.readouterr().err


def test_the_script_skips_at_this_code_only() -> None:
    script = (Path(windows_python.__file__).parent / "test_windows.sh").read_text(encoding="utf-8")
    assert f'{windows_python.UNAVAILABLE}) echo "skipped:' in script and "*) exit $code" in script
