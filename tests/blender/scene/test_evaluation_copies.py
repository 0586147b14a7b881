# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies in scenes of their own are removed completely, many of them at once."""

import bpy
from building import add_cube

from stiv.blender.scene.evaluation_copies import EvaluationCopies, remove_copies
from stiv.blender.scene.evaluations import VIEWPORT


def copies_of(*objects: object) -> EvaluationCopies:
    copies = EvaluationCopies(bpy.context.scene, VIEWPORT, own_data=objects)
    copies.fill(objects, lambda ob: True)
    return copies


def counts() -> tuple[int, ...]:
    return tuple(map(len, (bpy.data.scenes, bpy.data.objects, bpy.data.meshes)))


def test_many_copies_are_removed_at_once() -> None:
    cubes = [add_cube(f"Cube {number}") for number in range(3)]
    before = counts()
    made = [copies_of(cube) for cube in cubes]
    assert counts() == tuple(count + 3 for count in before)
    remove_copies(made)
    assert counts() == before


def test_copies_that_are_gone_do_not_keep_the_others() -> None:
    """Undo and other files remove them."""
    cubes = [add_cube(f"Cube {number}") for number in range(2)]
    before = counts()
    first, second = (copies_of(cube) for cube in cubes)
    first.remove()
    remove_copies([first, second])
    assert counts() == before
    first.remove()
