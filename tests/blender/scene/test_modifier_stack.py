# SPDX-License-Identifier: GPL-3.0-or-later
"""Supported modifier stacks equal Blender's evaluation after a random deformation; all others are refused by name."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import bpy
import numpy as np
import pytest
from building import (
    add,
    add_cube,
    add_grid,
    add_lattice,
    add_modifier,
    edit_mode,
    evaluated,
    mesh,
    select,
    shift,
    smooth_by_angle,
    snapshot,
)

import stiv
from stiv.blender import BlenderEdit, EditSettings
from stiv.blender.controls.editable import REASONS
from stiv.blender.scene.modifier_stack import MODIFIER_REASONS, SIMULATIONS

DEFORM = EditSettings(object_response="deform", guard="viewport")
NAME = "x" * 12  # of an object or a modifier

TENT = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 1), (0, -2, 0.3), (3, 0, 0)]
TENT_FACES = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (0, 5, 1)]


def begin(settings: EditSettings = DEFORM) -> BlenderEdit:
    return BlenderEdit.begin(bpy.context, settings, "move")


def follows(edit: BlenderEdit, ob: Any) -> None:
    """A random goal of the controls, solved, written: Blender must show the surface that the core computed.

    Edit Mode and Object Mode may be guarded apart, with the same surface.
    """
    matrix = np.eye(4)
    matrix[:3] += np.random.default_rng(7).normal(scale=0.2, size=(3, 4))
    assert edit.drag(matrix).status == "reached"
    assert edit.write().passed
    shown = evaluated(ob)
    assert np.abs(edit.surface.reshape(-1, *shown.shape) - shown).max() < 1e-5 * np.ptp(shown, axis=0).max()


def creased(ob: Any) -> None:
    edges = ob.data.attributes.new("crease_edge", "FLOAT", "EDGE")
    edges.data.foreach_set("value", np.linspace(0, 1, len(ob.data.edges)).astype(np.float32))
    vertices = ob.data.attributes.new("crease_vert", "FLOAT", "POINT")
    vertices.data.foreach_set("value", np.linspace(1, 0, len(ob.data.vertices)).astype(np.float32))


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize(
    "settings",
    [
        {"levels": 1},
        {"levels": 3},
        {"levels": 2, "quality": 1},
        {"levels": 2, "use_limit_surface": False},
        {"levels": 2, "boundary_smooth": "PRESERVE_CORNERS"},
        {"levels": 2, "subdivision_type": "SIMPLE"},
        {"levels": 2, "use_creases": False},
        {"levels": 0},
    ],
    ids=str,
)
def test_subdivision_as_the_viewport_shows_it(settings: dict[str, Any], mode: str) -> None:
    ob = add("Tent", mesh("Tent", TENT, TENT_FACES, [(4, 6)]), rotation_euler=(0.1, 0.2, 0.3), scale=(1, 2, -1))
    creased(ob)
    add_modifier(ob, "SUBSURF", **settings)
    (edit_mode if mode == "EDIT" else select)(ob)
    if mode == "EDIT":
        bpy.ops.mesh.select_all(action="SELECT")
    follows(begin(), ob)


def test_scene_simplify_caps_the_levels() -> None:
    ob = add_cube("Cube")
    add_modifier(ob, "SUBSURF", levels=3)
    bpy.context.scene.render.use_simplify = True
    bpy.context.scene.render.simplify_subdivision = 1
    select(ob)
    edit = begin()
    assert edit.surface.shape == (26, 3)
    follows(edit, ob)


def test_disabled_modifiers_are_left_out() -> None:
    ob = add_cube("Cube")
    add_modifier(ob, "BEVEL", show_viewport=False)
    add_modifier(ob, "SUBSURF", levels=1)
    add_modifier(ob, "SOLIDIFY", show_viewport=False)
    edit_mode(ob)
    bpy.ops.mesh.select_all(action="SELECT")
    follows(begin(), ob)


def test_cage_below_a_lattice_at_rest() -> None:
    ob = add_cube("Cube")
    add_modifier(ob, "LATTICE", object=add_lattice("At rest", (2, 3, 4), scale=(3, 3, 3)))
    add_modifier(ob, "SUBSURF", levels=2)
    select(ob)
    follows(begin(), ob)


def triangulated(ob: Any, lattice: Any) -> None:
    add_modifier(ob, "LATTICE", object=lattice)
    add_modifier(ob, "TRIANGULATE")


def lattice_alone(ob: Any, lattice: Any) -> None:
    add_modifier(ob, "LATTICE", object=lattice, strength=0.7)


def lattice_then_subdivision(ob: Any, lattice: Any) -> None:
    add_modifier(ob, "LATTICE", object=lattice)
    add_modifier(ob, "SUBSURF", levels=2)


def subdivision_then_lattice(ob: Any, lattice: Any) -> None:
    add_modifier(ob, "SUBSURF", levels=2)
    add_modifier(ob, "LATTICE", object=lattice, strength=1.2)


def behind_another_lattice(ob: Any, lattice: Any) -> None:
    other = add_lattice("Other", (2, 2, 2), (0.1, 0, 0), scale=(3, 4, 3))
    other.data.points[3].co_deform.x += 0.3
    add_modifier(ob, "LATTICE", object=other)
    add_modifier(ob, "LATTICE", object=lattice)
    add_modifier(ob, "LATTICE", object=add_lattice("At rest", (2, 2, 2)))


def with_a_vertex_group(ob: Any, lattice: Any) -> None:
    group = ob.vertex_groups.new(name="Gruppe")
    for index in range(0, len(ob.data.vertices), 2):
        group.add([index], 0.1 + index / 20, "REPLACE")
    add_modifier(ob, "LATTICE", object=lattice, vertex_group="Gruppe", invert_vertex_group=True, strength=0.8)
    add_modifier(ob, "SUBSURF", levels=1)


def with_a_vertex_group_after_subdivision(ob: Any, lattice: Any) -> None:
    group = ob.vertex_groups.new(name="Gruppe")
    group.add([1, 2, 3], 0.6, "REPLACE")
    add_modifier(ob, "SUBSURF", levels=2)
    add_modifier(ob, "LATTICE", object=lattice, vertex_group="Gruppe")


def with_the_lattices_own_group(ob: Any, lattice: Any) -> None:
    group = lattice.vertex_groups.new(name="Own")
    group.add(list(range(0, 24, 2)), 0.7, "REPLACE")
    lattice.data.vertex_group = "Own"
    add_modifier(ob, "LATTICE", object=lattice, strength=0.9)


STACKS = [
    lattice_alone, lattice_then_subdivision, subdivision_then_lattice, behind_another_lattice, with_a_vertex_group,
    with_a_vertex_group_after_subdivision, with_the_lattices_own_group, triangulated,
]  # fmt: skip


@pytest.mark.parametrize("kind", ["KEY_LINEAR", "KEY_CARDINAL", "KEY_CATMULL_ROM", "KEY_BSPLINE"])
@pytest.mark.parametrize("stack", STACKS)
def test_lattice_points(stack: Callable[[Any, Any], None], kind: str) -> None:
    ob = add_grid("Grid", 5, rotation_euler=(0.4, 0.1, 0))
    lattice = add_lattice("Käfig", (2, 3, 4), (0.2, 0.1, 0), rotation_euler=(0.2, 0.1, 0.3), scale=(2, -1.5, 1))
    for axis in "uvw":
        setattr(lattice.data, f"interpolation_type_{axis}", kind)
    stack(ob, lattice)
    select(lattice)
    follows(begin(), ob)


def refused(pattern: str, settings: EditSettings = DEFORM) -> None:
    before = snapshot()
    with pytest.raises(stiv.InputError, match=pattern) as raised:
        begin(settings)
    assert len(str(raised.value)) <= 80
    assert snapshot() == before


SHADING = [
    "NODES", "COLLISION", "WELD", "DATA_TRANSFER", "VERTEX_WEIGHT_EDIT", "VERTEX_WEIGHT_MIX", "VERTEX_WEIGHT_PROXIMITY",
    "UV_PROJECT", "UV_WARP", "WEIGHTED_NORMAL", "NORMAL_EDIT", "SURFACE", "EXPLODE", "CLOTH", "SOFT_BODY",
    "DYNAMIC_PAINT", "FLUID", "MESH_CACHE", "MESH_SEQUENCE_CACHE",
]  # fmt: skip


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("kind", SHADING)
def test_modifiers_that_leave_positions_alone(kind: str, mode: str) -> None:
    ob = add("Tent", mesh("Tent", TENT, TENT_FACES, [(4, 6)]), rotation_euler=(0.1, 0.2, 0.3))
    add_modifier(ob, "SUBSURF", levels=2, render_levels=1)
    add_modifier(ob, kind)
    if kind == "NODES":
        ob.modifiers[1].node_group = smooth_by_angle()
    (edit_mode if mode == "EDIT" else select)(ob)
    if mode == "EDIT":
        bpy.ops.mesh.select_all(action="SELECT")
    before = snapshot()
    edit = begin(replace(DEFORM, guard="both"))
    assert snapshot() == before
    edit.drag(shift(0.1, 0.2, 0.3))
    assert edit.write().passed
    follows(begin(), ob)


WITH_A_LATTICE = {
    ("SOLIDIFY",): 'Böx: Solidify "SOLIDIFY" is not supported; apply it',
    ("SUBSURF", "SUBSURF"): 'Böx: Subdivision.* "SUBSURF.001" is the second; apply the first',
    ("TRIANGULATE", "SUBSURF"): 'Böx: Triangulate "TRIANGULATE" precedes a subdivision',
}


@pytest.mark.parametrize("kinds", WITH_A_LATTICE)
def test_lattices_refuse_other_modifiers_by_name(kinds: tuple[str, ...]) -> None:
    """The vertices below the same modifiers can be edited."""
    ob, lattice = add_cube("Böx"), add_lattice("Lattice", (2, 2, 2))
    add_modifier(ob, "LATTICE", object=lattice)
    for kind in kinds:
        add_modifier(ob, kind, kind)
    select(lattice)
    refused(WITH_A_LATTICE[kinds])
    if "TRIANGULATE" not in kinds:  # small motions change the diagonals of flat faces
        select(ob)
        begin()


def test_a_deformed_lattice_after_the_moving_one_is_refused() -> None:
    ob, first, second = add_cube("Cube"), add_lattice("First", (2, 2, 2)), add_lattice("Second", (2, 2, 2))
    second.data.points[0].co_deform.x -= 0.5
    add_modifier(ob, "LATTICE", object=first)
    add_modifier(ob, "LATTICE", "Later", object=second)
    select(first)
    refused('Cube: Lattice "Later" follows the moving lattice; apply it')


def test_lattice_twice_in_a_stack_is_refused() -> None:
    ob, lattice = add_cube("Cube"), add_lattice("Lattice", (2, 2, 2))
    add_modifier(ob, "LATTICE", "One", object=lattice)
    add_modifier(ob, "LATTICE", "Two", object=lattice)
    select(lattice)
    refused('Cube: Lattice "Two" uses "Lattice" again; apply it')


def test_an_evaluation_that_differs_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """The comparison with Blender's evaluation would find an error in the computation."""
    ob = add_cube("Cube")
    add_modifier(ob, "SUBSURF", "Subdivision ü", levels=1)
    from stiv.blender.controls import cage_surface, subdivision

    wrong = lambda data, stage: stiv.linear(stiv.linear_weights(subdivision.subdivide(data, stage))[0], shift_by(26))  # noqa: E731
    monkeypatch.setattr(cage_surface, "subdivide", wrong)
    select(ob)
    refused("Cube: its modifiers cannot be followed .*; apply them")


def shift_by(count: int) -> np.ndarray:
    offset = np.zeros((count, 3))
    offset[-1] = shift(z=1e-3)[:3, 3]
    return offset


FOR_LATTICES = ["ARMATURE", "CAST", "CURVE", "HOOK", "MESH_DEFORM", "SHRINKWRAP", "SIMPLE_DEFORM", "SURFACE_DEFORM"]


def test_messages_fit_the_status_bar() -> None:
    """With object and modifier names of 12 characters."""
    kinds = {item.identifier: item.name for item in bpy.types.Modifier.bl_rna.properties["type"].enum_items}
    lattice_reasons = ("after moving lattice", "deformed lattice", "same lattice")
    of_reason = {reason: [kinds["LATTICE"]] for reason in lattice_reasons}
    of_reason |= {"before subdivision": [kinds["TRIANGULATE"]], "second subdivision": [kinds["SUBSURF"]]}
    of_reason |= {"projects": [kinds["SHRINKWRAP"]], "simulated": [kinds[kind] for kind in SIMULATIONS]}
    of_reason |= {"flips quads": [kinds["TRIANGULATE"]], "shows instances": [kinds["NODES"]]}
    of_reason["own transform"] = [kinds["NODES"]]
    of_reason["no surface"] = [kinds[kind] for kind in ("MASK", "BUILD", "NODES", "REMESH", "MESH_TO_VOLUME")]
    of_reason["of lattice"] = [kinds[kind] for kind in FOR_LATTICES]
    of_reason["ignores vertices in renders"] = [kinds[kind] for kind in kinds if "VERTEX_WEIGHT" not in kind]
    messages = [
        f'{NAME}: {kind} "{NAME}" {text.format(other=NAME)}'
        for reason, text in MODIFIER_REASONS.items()
        for kind in of_reason.get(reason, kinds.values())
    ]
    messages += [f"{NAME}: {text.format(kind='lattice', other=NAME)}" for text in REASONS.values()]
    assert [message for message in messages if len(message) > 80] == []
