# SPDX-License-Identifier: GPL-3.0-or-later
"""Deformations, handles and weights of the panel in edits by the operators."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import MagicMock

import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture(autouse=True)
def bar() -> Any:
    """A bar of 8 rings along x from -2 to 2, with the groups "Left" and "Right" at its ends, selected."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    ring = [(-0.3, -0.3), (0.3, -0.3), (0.3, 0.3), (-0.3, 0.3)]
    points = [(x, y, z) for x in np.linspace(-2, 2, 8) for y, z in ring]
    sides = [
        (4 * r + k, 4 * r + (k + 1) % 4, 4 * r + 4 + (k + 1) % 4, 4 * r + 4 + k) for r in range(7) for k in range(4)
    ]
    data = bpy.data.meshes.new("Bar")
    data.from_pydata(points, [], [(3, 2, 1, 0), *sides, (28, 29, 30, 31)])
    obj = bpy.data.objects.new("Bar", data)
    bpy.context.collection.objects.link(obj)
    for name, vertices in (("Left", range(4)), ("Right", range(28, 32))):
        obj.vertex_groups.new(name=name).add(list(vertices), 1.0, "REPLACE")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    return obj


def local(obj: Any) -> np.ndarray:
    return np.array([tuple(vertex.co) for vertex in obj.data.vertices], np.float32)


@pytest.mark.parametrize("kind", ["laplacian", "arap"])
def test_handles_of_the_panel_move_a_mesh_softly(bar: Any, kind: str) -> None:
    bar.stiv.deformation = kind
    bar.vertex_groups.active_index = 1
    assert bpy.ops.stiv.handle_add() == {"FINISHED"}
    assert [row.name for row in bar.stiv.handles] == ["Right"]
    bar.stiv.anchor = "Left"
    before = local(bar)
    assert bpy.ops.stiv.move(value=(0.0, 0.0, 1.0)) == {"FINISHED"}
    after = local(bar)
    assert (after[:4] == before[:4]).all()
    assert after[28:] == pytest.approx(before[28:] + (0, 0, 1), abs=1e-6)
    assert 0.2 < (after - before)[16:20, 2].mean() < 0.9


def test_rows_without_a_group_are_ignored(bar: Any) -> None:
    bar.stiv.deformation = "laplacian"
    for _ in range(2):
        bpy.ops.stiv.handle_add()
    assert [row.name for row in bar.stiv.handles] == ["Right", ""]
    with pytest.raises(RuntimeError, match="Handle 5 does not exist"):
        bpy.ops.stiv.handle_remove(index=5)
    bpy.ops.stiv.handle_remove(index=0)
    with pytest.raises(RuntimeError, match="Bar: it has no handle"):
        bpy.ops.stiv.move(value=(1.0, 0.0, 0.0))


def test_weights_of_the_panel_pin_vertices(bar: Any) -> None:
    bar.stiv.deformation = "vertices"
    bar.stiv.weight_group, bar.stiv.weight_invert = "Left", True
    before = local(bar)
    bpy.ops.stiv.move(value=(0.0, 0.0, 0.5))
    assert (local(bar)[:4] == before[:4]).all()
    assert local(bar)[4:] == pytest.approx(before[4:] + (0, 0, 0.5), abs=1e-6)


def test_weight_axes_of_the_panel_pin_single_coordinates(bar: Any) -> None:
    bar.stiv.deformation = "vertices"
    bar.rotation_euler.x = np.pi / 2
    bar.stiv.weight_group, bar.stiv.weight_invert, bar.stiv.weight_axes = "Left", True, (False, False, True)
    before = local(bar)
    bpy.ops.stiv.move(value=(0.25, -0.5, 1.0))  # along the bar's axes: (0.25, 1.0, 0.5)
    now = local(bar)
    assert (now[:4, 2] == before[:4, 2]).all()
    assert now[:4, :2] == pytest.approx(before[:4, :2] + (0.25, 1.0), abs=1e-6)
    assert now[4:] == pytest.approx(before[4:] + (0.25, 1.0, 0.5), abs=1e-6)


def test_weights_and_their_axes_come_from_an_edit_script(bar: Any, tmp_path: Path) -> None:
    from stiv.blender.scripts.replaying import replay
    from stiv.edit_scripts import read_edit_script

    chosen = {"deformation": "vertices", "weight_group": "Right", "weight_axes": [True, False, False]}
    step = {"operator": "move", "objects": ["Bar"], "values": {"value": [0.5, 0.0, 0.25]}}
    script = {"schema": "stiv-edits", "version": 1, "settings": {"objects": {"Bar": chosen}}, "steps": [step]}
    (tmp_path / "edits.json").write_text(json.dumps(script))
    before = local(bar)
    replay(read_edit_script(tmp_path / "edits.json"))
    now = local(bar)
    assert (now[:28, 0] == before[:28, 0]).all()
    assert now[:28, 2] == pytest.approx(before[:28, 2] + 0.25)
    assert now[28:] == pytest.approx(before[28:] + (0.5, 0, 0.25))


def test_without_collisions_objects_pass_through_each_other(bar: Any) -> None:
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(0, 0, 3))
    bpy.context.scene.stiv.interference = False
    bpy.ops.stiv.move(value=(0.0, 0.0, -3.0))
    assert tuple(bpy.data.objects["Cube"].location) == (0, 0, 0)
    bpy.context.scene.stiv.interference = True
    with pytest.raises(RuntimeError, match="intersect"):
        bpy.ops.stiv.move(value=(0.0, 0.0, 3.0))


def test_the_minimum_distance_is_automatic_until_one_is_chosen() -> None:
    settings = bpy.context.scene.stiv
    settings.separation = 0.0
    assert settings.automatic_separation
    settings.automatic_separation = False
    assert settings.separation > 0.0 and not settings.automatic_separation
    settings.automatic_separation = True
    assert settings.separation == 0.0


def test_the_panel_of_roles_does_not_translate_names(bar: Any) -> None:
    from stiv_addon.panels.objects import STIV_PT_roles

    layout = MagicMock()
    STIV_PT_roles.draw(SimpleNamespace(layout=layout), bpy.context)
    layout.row().label.assert_called_once_with(text="Bar", translate=False, icon="OUTLINER_OB_MESH")


def test_the_panel_of_deformation_draws_handles_and_weights(bar: Any) -> None:
    """Drawn into a replacement of the layout: Blender reports a wrong property only in a window."""
    from stiv_addon.panels.objects import STIV_PT_deformation

    drawn: list[str] = []

    class Layout:
        use_property_split = active = False

        def row(self, align: bool, heading: str = "") -> "Layout":
            return self

        def box(self) -> "Layout":
            return self

        def prop(self, owner: Any, name: str, **words: Any) -> None:
            assert hasattr(owner, name)
            drawn.append(name)

        def prop_search(self, owner: Any, name: str, source: Any, collection: str, **words: Any) -> None:
            assert hasattr(owner, name) and hasattr(source, collection)
            drawn.append(name)

        def operator(self, name: str, **words: Any) -> Any:
            assert hasattr(bpy.ops.stiv, name.partition(".")[2])
            return type("Properties", (), {})()

    bar.stiv.deformation = "arap"
    bpy.ops.stiv.handle_add()
    STIV_PT_deformation.draw(type("Panel", (), {"layout": Layout()})(), bpy.context)
    assert {"deformation", "name", "anchor", "rest", "pull", "weight_group", "weight_invert"} <= set(drawn)
    assert drawn.count("weight_axes") == 3
