# SPDX-License-Identifier: GPL-3.0-or-later
"""Every copy that an evaluation makes in an edit mode is noted: Blender's undo depends on it."""

from collections.abc import Iterator

import bpy
import pytest

from stiv.blender.scene.evaluation_copies import open_copies
from stiv.blender.scene.evaluations import RENDER
from stiv.blender.scene.lattice_reading import read_rest_lattice_points
from stiv.blender.scene.temporary_data import copies_made, on_copies
from stiv.blender.scene.vertex_groups import group_weights


@pytest.fixture
def calls() -> Iterator[list[str]]:
    """A word for each call of the listener."""
    words: list[str] = []
    on_copies(lambda: words.append("copied"))
    yield words
    on_copies(None)


def test_copies_of_objects_and_of_edited_lattices_are_noted(calls: list[str]) -> None:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.object.add(type="LATTICE")
    lattice = bpy.context.object
    lattice.vertex_groups.new(name="Group")
    before = copies_made()
    read_rest_lattice_points(lattice.data)
    assert not calls
    bpy.ops.object.mode_set(mode="EDIT")
    read_rest_lattice_points(lattice.data)
    group_weights(lattice, "Group", "a test")
    with open_copies(bpy.context, RENDER, [lattice], lambda ob: True):
        pass
    assert len(calls) == 3 == copies_made() - before
