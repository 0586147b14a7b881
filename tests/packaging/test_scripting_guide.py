# SPDX-License-Identifier: GPL-3.0-or-later
"""The scripts of the guide for scripts do what it says, and it names what there is."""

import re
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy")

import stiv.blender  # noqa: E402

pytestmark = pytest.mark.usefixtures("registered")

GUIDE = (Path(__file__).resolve().parents[2] / "docs/scripting.md").read_text(encoding="utf-8")
OPERATORS, EDITS = re.findall(r"```python\n(.*?)```", GUIDE, re.DOTALL)


def printed(script: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    exec(compile(script, "scripting.md", "exec"), {})
    return [line for line in capsys.readouterr().out.splitlines() if line and not line.startswith(("Info", "Read"))]


def test_operators_stop_at_what_is_in_the_way(capsys: pytest.CaptureFixture[str]) -> None:
    (told,) = printed(OPERATORS, capsys)
    assert told.startswith(("corrected", "blocked"))
    assert bpy.ops.stiv.check() == {"FINISHED"}
    assert bpy.context.window_manager.stiv_check.summary.startswith("No intersections")


def test_an_edit_and_what_follows_another_tool_stay_free(capsys: pytest.CaptureFixture[str]) -> None:
    dragged, followed = printed(EDITS, capsys)
    assert dragged == "corrected True 0"
    assert followed.startswith("True") and float(followed.split()[-1]) < 1.01
    assert not stiv.blender.check_scene(bpy.context).pairs


def test_every_operator_and_property_is_there() -> None:
    table = GUIDE.split("| `bpy.ops.stiv.` | properties |")[1].split("\n\n")[0]
    rows = re.findall(r"^\| ((?:`\w+`(?:, )?)+) \| (.*) \|$", table, re.MULTILINE)
    assert len(rows) >= 9
    for names, properties in rows:
        for name in re.findall(r"`(\w+)`", names):
            known = getattr(bpy.ops.stiv, name).get_rna_type().properties.keys()
            mentioned = set(re.findall(r"`([a-z_]+)`", properties.partition("; the result")[0]))
            assert mentioned <= set(known), (name, mentioned - set(known))


def test_every_setting_is_there() -> None:
    owners = {"scene": bpy.context.scene.stiv, "object": bpy.data.objects.new("Any", None).stiv}
    for kind, owner in owners.items():
        first, others = re.search(rf"`{kind}\.stiv\.(\w+)`((?:,\s+`\.\w+`)+)", GUIDE).groups()
        names = [first, *re.findall(r"`\.(\w+)`", others)]
        assert len(names) > 5 and set(names) <= set(owner.bl_rna.properties.keys())


def test_every_name_of_the_package_is_there() -> None:
    for name in re.findall(r"`([a-z]+_scene|read_state|compare|follow|revert|[A-Z]\w+)`", GUIDE):
        assert hasattr(stiv.blender, name) or name in ("SCENE", "ON", "OFF", "GLOBAL", "LOCAL", "RuntimeError"), name
