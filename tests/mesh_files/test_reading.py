# SPDX-License-Identifier: GPL-3.0-or-later
"""Choice of the reader."""

import pytest

import stiv
from stiv.mesh_files import read_mesh


def test_unknown_kinds_are_refused_with_the_known_ones(tmp_path):
    with pytest.raises(stiv.InputError, match=r"unknown format; supported are \.obj, \.ply, \.npz and \.blend"):
        read_mesh(tmp_path / "mesh.stl")


@pytest.mark.parametrize("name", ["missing.obj", "missing.ply", "missing.npz"])
def test_missing_files_are_named(tmp_path, name):
    with pytest.raises(stiv.InputError, match=f"{name}: cannot be read: No such file"):
        read_mesh(tmp_path / name)
