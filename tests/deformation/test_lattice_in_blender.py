# SPDX-License-Identifier: GPL-3.0-or-later
"""Lattices, and their chains with subdivision, against what Blender's modifiers evaluate."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

bpy = pytest.importorskip("bpy", reason="needs Blender as a Python module (bpy)")

import stiv  # noqa: E402
from tests.deformation.cages import CageCase, creased_cylinder, torus, wires_on_a_sheet  # noqa: E402
from tests.deformation.evaluated_meshes import (  # noqa: E402
    cage_of,
    evaluated_positions,
    linked,
    new_mesh,
    read,
    size_of,
)

Floats = NDArray[np.float64]
TOLERANCE = 1e-5  # of the object's size
INTERPOLATIONS = ("linear", "cardinal", "catmull_rom", "bspline")


def to_world(item: Any, points: Floats) -> Floats:
    frame = np.array(item.matrix_world)
    return points @ frame[:3, :3].T + frame[:3, 3]


@dataclass
class LatticeScene:
    """A mesh object and a lattice object, the second one a modifier of the first."""

    item: Any
    cage: Any
    modifier: Any

    @property
    def points(self) -> Any:
        return self.cage.data.points

    def set_lattice(self, resolution: tuple[int, int, int], interpolation: tuple[str, str, str], scale: float) -> None:
        data = self.cage.data
        data.points_u, data.points_v, data.points_w = resolution
        for axis, name in zip("uvw", interpolation, strict=True):
            setattr(data, f"interpolation_type_{axis}", "KEY_" + name.upper())
        self.cage.scale = (1.1 * scale, -0.8 * scale, 1.3 * scale)
        bpy.context.view_layer.update()

    def deform(self, seed: int) -> Floats:
        """Move all points at random; their world positions."""
        rest = read(self.points, "co")
        moved = rest + np.random.default_rng(seed).normal(scale=0.3, size=rest.shape)
        self.points.foreach_set("co_deform", moved.astype(np.float32).ravel())
        self.cage.data.update_tag()
        return to_world(self.cage, read(self.points, "co_deform"))

    def deformation(self, vertices: Floats, **options: Any) -> stiv.Deformation:
        """The lattice's deformation of vertices in the object's own space."""
        data = self.cage.data
        return stiv.lattice(
            to_world(self.item, vertices),
            (data.points_u, data.points_v, data.points_w),
            frame=np.array(self.cage.matrix_world),
            interpolation=[getattr(data, f"interpolation_type_{axis}").removeprefix("KEY_").lower() for axis in "uvw"],
            rest=read(self.points, "co"),
            **options,
        )

    def check(self, deformation: stiv.Deformation, seeds: int = 3) -> None:
        """Compare in world space, for several deformations of the lattice."""
        for seed in range(seeds):
            controls = self.deform(seed)
            expected = to_world(self.item, evaluated_positions(self.item))
            found = deformation.surface(controls)
            assert found.shape == expected.shape
            assert np.abs(found - expected).max() < TOLERANCE * size_of(expected)


@pytest.fixture
def case() -> CageCase:
    """The mesh in the lattice; tests may give another one."""
    return torus(8, 5)


@pytest.fixture
def scene(case: CageCase) -> Iterator[LatticeScene]:
    with linked(new_mesh(case)) as item:
        data = bpy.data.lattices.new("lattice")
        cage = bpy.data.objects.new("lattice", data)
        bpy.context.collection.objects.link(cage)
        item.location, item.rotation_euler, item.scale = (0.1, 0.2, -0.1), (0.2, -0.4, 0.1), (0.9, -1.2, 1.05)
        cage.location, cage.rotation_euler = (0.2, -0.1, 0.3), (0.3, 0.5, -0.2)
        modifier = item.modifiers.new("lattice", "LATTICE")
        modifier.object = cage
        yield LatticeScene(item, cage, modifier)
        bpy.data.objects.remove(cage)
        bpy.data.lattices.remove(data)


@pytest.mark.parametrize("interpolation", INTERPOLATIONS)
@pytest.mark.parametrize("scale", [4.0, 0.5], ids=["inside", "partly outside"])
def test_interpolation(scene: LatticeScene, interpolation: str, scale: float) -> None:
    scene.set_lattice((4, 5, 3), (interpolation,) * 3, scale)
    scene.check(scene.deformation(read(scene.item.data.vertices, "co")))


@pytest.mark.parametrize("resolution", [(1, 3, 4), (2, 2, 2), (3, 1, 1), (2, 3, 5), (8, 8, 8)])
def test_resolution(scene: LatticeScene, resolution: tuple[int, int, int]) -> None:
    for interpolation in (("bspline",) * 3, ("bspline", "linear", "catmull_rom")):
        scene.set_lattice(resolution, interpolation, 2.0)
        scene.check(scene.deformation(read(scene.item.data.vertices, "co")))


def test_undeformed_lattice_moves_nothing(scene: LatticeScene) -> None:
    scene.set_lattice((4, 4, 4), ("bspline",) * 3, 1.5)
    vertices = read(scene.item.data.vertices, "co")
    world = to_world(scene.item, vertices)
    rest = to_world(scene.cage, read(scene.points, "co"))
    assert np.abs(scene.deformation(vertices).surface(rest) - world).max() < 1e-14 * size_of(world)


def group_weights(scene: LatticeScene, item: Any, count: int, seed: int) -> Floats:
    """A vertex group on every other element, as stored."""
    group = item.vertex_groups.new(name="group")
    weights = np.random.default_rng(seed).random(count).astype(np.float32).astype(float)
    weights[1::2] = 0
    for k in range(0, count, 2):
        group.add([k], weights[k], "REPLACE")
    return weights


@pytest.mark.parametrize("inverted", [False, True])
@pytest.mark.parametrize("own_group", [False, True])
def test_strength_and_groups(scene: LatticeScene, inverted: bool, own_group: bool) -> None:
    scene.set_lattice((4, 4, 4), ("bspline",) * 3, 2.0)
    vertices = read(scene.item.data.vertices, "co")
    scene.modifier.strength = 0.35
    weights = group_weights(scene, scene.item, len(vertices), 11)
    scene.modifier.vertex_group, scene.modifier.invert_vertex_group = "group", inverted
    options: dict[str, Any] = {"influence": scene.modifier.strength * ((1 - weights) if inverted else weights)}
    if own_group:
        options["point_weights"] = group_weights(scene, scene.cage, len(scene.points), 12)
        scene.cage.data.vertex_group = "group"
    scene.check(scene.deformation(vertices, **options))


def test_points_hidden_inside_count_as_stored(scene: LatticeScene) -> None:
    scene.set_lattice((4, 4, 4), ("bspline",) * 3, 1.5)
    scene.cage.data.use_outside = True
    scene.check(scene.deformation(read(scene.item.data.vertices, "co")))


@pytest.mark.parametrize("case", [torus(8, 5), creased_cylinder(), wires_on_a_sheet()])
@pytest.mark.parametrize("limit_surface", [True, False])
def test_lattice_then_subdivision(scene: LatticeScene, limit_surface: bool) -> None:
    scene.set_lattice((4, 3, 5), ("bspline",) * 3, 1.5)
    modifier = scene.item.modifiers.new("subdivision", "SUBSURF")
    modifier.levels, modifier.use_limit_surface = 2, limit_surface
    subdivision = stiv.subdivision_weights(cage_of(scene.item.data), 2, limit_surface=limit_surface)
    chain = stiv.compose(subdivision, scene.deformation(read(scene.item.data.vertices, "co")))
    scene.check(chain)


def test_subdivision_then_lattice(scene: LatticeScene) -> None:
    scene.set_lattice((4, 3, 5), ("cardinal",) * 3, 1.5)
    scene.item.modifiers.new("subdivision", "SUBSURF").levels = 2
    scene.item.modifiers.move(1, 0)
    subdivision = stiv.linear(stiv.subdivision_weights(cage_of(scene.item.data), 2))
    scene.check(scene.deformation(subdivision.surface(read(scene.item.data.vertices, "co"))))


def test_cage_under_an_undeformed_lattice(scene: LatticeScene) -> None:
    """Edits of the cage under a lattice at rest: the lattice passes everything on."""
    scene.set_lattice((3, 3, 3), ("bspline",) * 3, 2.0)
    scene.item.modifiers.new("subdivision", "SUBSURF").levels = 2
    mesh = scene.item.data
    moved = read(mesh.vertices, "co") + np.random.default_rng(13).normal(scale=0.2, size=(len(mesh.vertices), 3))
    mesh.vertices.foreach_set("co", moved.astype(np.float32).ravel())
    mesh.update()
    expected = to_world(scene.item, evaluated_positions(scene.item))
    found = stiv.linear(stiv.subdivision_weights(cage_of(mesh), 2)).surface(
        to_world(scene.item, read(mesh.vertices, "co"))
    )
    assert np.abs(found - expected).max() < TOLERANCE * size_of(expected)
