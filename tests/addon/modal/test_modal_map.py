# SPDX-License-Identifier: GPL-3.0-or-later
"""Every entry of Blender's own map of keys during a transform is handled, or the guide says why not."""

import importlib.util
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from stiv_addon.modal.axis_lock import AxisLock
from stiv_addon.modal.event import Event
from stiv_addon.modal.event_handling import step
from stiv_addon.modal.pointer import Pointer
from stiv_addon.modal.proportional import Proportional
from stiv_addon.modal.request import Request
from stiv_addon.modal.state import Effect, State

bpy = pytest.importorskip("bpy")
GUIDE = Path(__file__).resolve().parents[3] / "docs/user_guide.md"
START = State(Pointer.at((100.0, 100.0)))
# Between them, every key that is handled changes something.
STATES = (
    START,
    replace(START, request=Request("rotate")),
    replace(START, axis_lock=AxisLock(1), snap_points=((1.0, 0.0, 0.0),)),
    replace(START, precise=True, ctrl=True),
    replace(START, picking_base=True),
    replace(START, proportional=Proportional(True, True)),
)


def entries() -> Iterator[tuple[str, dict]]:
    """Names and keys of the entries, as Blender's default keymap defines them."""
    path = Path(bpy.utils.system_resource("SCRIPTS"), "presets/keyconfig/keymap_data/blender_default.py")
    spec = importlib.util.spec_from_file_location("blender_default", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for name, _, content in module.generate_keymaps(module.Params(use_alt_navigation=True)):
        if name == "Transform Modal Map":
            for entry, key, _ in content["items"]:
                yield entry, key


def listed() -> dict[str, bool]:
    """The entries of the guide's table, and whether they are handled."""
    rows = re.findall(r"^\| (`[A-Z_`, ]+`) \| (.+) \|$", GUIDE.read_text(), re.MULTILINE)
    return {name: not text.startswith("no:") for names, text in rows for name in re.findall(r"`([A-Z_]+)`", names)}


def does_something(key: dict) -> bool:
    modifiers = frozenset(name for name in ("shift", "ctrl", "alt") if key.get(name))
    values = {"ANY": ("PRESS", "NOTHING")}.get(key["value"], (key["value"],))
    for state in STATES:
        for value in values:
            event = Event(key["type"], value, modifiers=modifiers, pan=9.0, target=(1.0, 2.0, 3.0), axis=0)
            after, effect = step(state, event)
            if after != state or effect not in (Effect.NONE, Effect.PASS):
                return True
    return False


def test_every_entry_of_blenders_map_is_handled_or_listed() -> None:
    known, found = listed(), list(entries())
    assert len({name for name, _ in found}) > 30 and known
    assert sorted({name for name, _ in found} - set(known)) == []
    unhandled = [name for name, key in found if known[name] and not does_something(key)]
    assert set(unhandled) <= {"PASSTHROUGH_NAVIGATE"}  # Alt itself does nothing; with the button it navigates
    held = Event("MIDDLEMOUSE", modifiers=frozenset({"alt"}))
    assert step(START, held)[1] is Effect.NAVIGATE
