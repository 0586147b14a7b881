# SPDX-License-Identifier: GPL-3.0-or-later
"""The scripting guide names existing operators, settings and functions; test_examples runs its scripts."""

import re
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")

import stiv.blender  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")

GUIDE = (Path(__file__).resolve().parents[2] / "docs/scripting.md").read_text(encoding="utf-8")


def test_every_operator_and_property_exists() -> None:
    table = GUIDE.split("| `bpy.ops.stiv.` | properties |")[1].split("\n\n")[0]
    rows = re.findall(r"^\| ((?:`\w+`(?:, )?)+) \| (.*) \|$", table, re.MULTILINE)
    assert len(rows) >= 9
    for names, properties in rows:
        for name in re.findall(r"`(\w+)`", names):
            known = getattr(bpy.ops.stiv, name).get_rna_type().properties.keys()
            mentioned = set(re.findall(r"`([a-z_]+)`", properties.partition("; the result")[0]))
            assert mentioned <= set(known), (name, mentioned - set(known))


def test_every_setting_exists() -> None:
    owners = {"scene": bpy.context.scene.stiv, "object": bpy.data.objects.new("Any", None).stiv}
    for kind, owner in owners.items():
        first, others = re.search(rf"`{kind}\.stiv\.(\w+)`((?:,\s+`\.\w+`)+)", GUIDE).groups()
        names = [first, *re.findall(r"`\.(\w+)`", others)]
        assert len(names) > 5 and set(names) <= set(owner.bl_rna.properties.keys())


def test_every_name_of_the_package_exists() -> None:
    for name in re.findall(r"`([a-z]+_scene|read_state|compare|follow|revert|[A-Z]\w+)`", GUIDE):
        assert hasattr(stiv.blender, name) or name in ("SCENE", "ON", "OFF", "GLOBAL", "LOCAL", "RuntimeError"), name
