# SPDX-License-Identifier: GPL-3.0-or-later
"""`make extension` gives each zip to the validator of each release of Blender."""

import tomllib
import zipfile
from pathlib import Path

import pytest

from tools import build_extension, validate_extension


def zipped(folder: Path, manifest: str) -> Path:
    path = folder / "stiv.zip"
    with zipfile.ZipFile(path, "w") as files:
        files.writestr("blender_manifest.toml", manifest)
        files.writestr("__init__.py", "")
        for wheel in tomllib.loads(manifest).get("wheels", []):
            files.writestr(wheel.removeprefix("./"), "")
    return path


def test_validators_that_are_installed_take_a_good_manifest_and_refuse_bad_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    root = validate_extension.ROOT
    installed = [name for name in validate_extension.releases() if (root / f"build/venv-blender-{name}/bin").is_dir()]
    if not installed:
        pytest.skip("no Blender module in build/venv-blender-*")
    monkeypatch.setattr(validate_extension, "releases", lambda: dict.fromkeys(installed, "3.11"))
    good = build_extension.filled_manifest([tmp_path / "stiv-1.0.0-cp311-cp311-win_amd64.whl"])
    assert validate_extension.main(tmp_path, [zipped(tmp_path, good)]) == 0
    assert "refused" not in capsys.readouterr().out
    for bad in (good.replace("blender_version_min", "blender_minimum"), good.replace('"Modeling"', '"No Such Tag"')):
        assert bad != good
        assert validate_extension.main(tmp_path, [zipped(tmp_path, bad)]) == len(installed)
        assert f"refused by {', '.join(installed)}" in capsys.readouterr().out


def test_a_release_that_cannot_be_had_is_named_and_refuses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(validate_extension, "releases", lambda: {"9.9.9": "3.99"})
    monkeypatch.setattr(validate_extension, "scripts_of", lambda *_: None)
    assert validate_extension.main(tmp_path, [tmp_path / "stiv.zip"]) == 0
    assert "not validated, because PyPI has no module: 9.9.9" in capsys.readouterr().out
