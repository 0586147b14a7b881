# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit scripts: valid ones are read, invalid ones rejected."""

from pathlib import Path

import pytest

import stiv
from stiv.edit_scripts import parse_edit_script, read_edit_script

STEP = {"operator": "move", "objects": ["A"], "values": {"value": [0, 0, 1]}}
FIXTURES = Path(__file__).resolve().parents[1] / "blend_fixtures"


def script(**changes):
    return {"schema": "stiv-edits", "version": 1, "steps": [{**STEP, **changes}]}


def test_defaults_and_repeats():
    read = parse_edit_script(script(repeat=3))
    step = read.steps[0]
    assert (step.mode, step.points, step.objects, step.values) == ("OBJECT", None, ("A",), {"value": (0.0, 0.0, 1.0)})
    assert len(read) == 3 and list(read.edits()) == [step] * 3


def test_values_of_reshaping_steps_are_optional():
    bare = {"operator": "repair", "objects": ["A"]}
    given = {"operator": "contract", "objects": ["A"], "values": {"steps": 3, "until_free": True}}
    read = parse_edit_script({"schema": "stiv-edits", "version": 1, "steps": [bare, given]})
    assert [dict(step.values) for step in read.steps] == [{}, given["values"]]


@pytest.mark.parametrize(
    ("operator", "values", "message"),
    [
        ("expand", {"share": 0.5}, 'step 0: expand takes the values amount, not "share"'),
        ("expand", {"amount": True}, "step 0: amount: a finite number expected, not True"),
        ("contract", {"steps": 1.5}, "step 0: steps: a whole number expected"),
        ("repair", {"weld": 1}, "step 0: weld: true or false expected"),
        ("settle", [], "step 0: values: not an object"),
    ],
)
def test_bad_values_of_reshaping_steps_are_named(operator, values, message):
    with pytest.raises(stiv.InputError, match=message):
        parse_edit_script(script(operator=operator, values=values))


def test_every_fixture_has_a_script_that_can_be_read():
    blends = sorted(set(FIXTURES.rglob("*.blend")) - set((FIXTURES / "examples").iterdir()))
    assert len(blends) >= 22
    for blend in blends:
        assert len(read_edit_script(blend.with_suffix(".edits.json"))) > 0


def test_the_plant_takes_at_least_sixty_edits():
    assert len(read_edit_script(FIXTURES / "plant_in_vase.edits.json")) >= 60


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"operator": "melt"}, "step 0: operator 'melt' is none of move, scale, rotate"),
        ({"operator": ["move"]}, r"step 0: operator \['move'\] is none of"),
        ({"mode": "SCULPT"}, "step 0: mode 'SCULPT'"),
        ({"mode": ["EDIT"]}, r"step 0: mode \['EDIT'\]"),
        ({"objects": []}, '"objects" is not a list of object names'),
        ({"objects": ["A", "B"], "mode": "EDIT"}, "Edit Mode takes one object, not 2"),
        ({"points": [1]}, '"points" are selected in Edit Mode only'),
        ({"mode": "EDIT", "points": [-1]}, 'neither "all" nor a list of indices'),
        ({"mode": "EDIT", "points": [True]}, 'neither "all" nor a list of indices'),
        ({"values": {"angle": 1}}, "move takes the values value, not angle"),
        ({"values": {"value": [0, 0, 1], "constraint_axis": [1, 0, 0]}}, "constraint_axis: three of true or false"),
        ({"values": {"value": [0, 0]}}, "step 0: value: 3 finite numbers expected"),
        ({"values": {"value": [0, 0, float("nan")]}}, "step 0: value: 3 finite numbers expected"),
        ({"values": {"value": [0, 0, 10**400]}}, "step 0: value: 3 finite numbers expected"),
        ({"repeat": 0}, "repeat 0 is not a whole number above 0"),
        ({"repeat": 10**8}, "100000000 edits, more than the limit"),
        ({"colour": "red"}, 'unknown field "colour"'),
        ({"settings": []}, "step 0: settings: not an object"),
    ],
)
def test_bad_steps_are_named(changes, message):
    with pytest.raises(stiv.InputError, match=message):
        parse_edit_script(script(**changes))


@pytest.mark.parametrize("data", [None, [], {}, {"schema": "stiv-edits"}, {"schema": "stiv-edits", "version": 1}])
def test_other_json_is_refused(data):
    with pytest.raises(stiv.InputError):
        parse_edit_script(data)


@pytest.mark.parametrize("text", ["", "{", "[" * 100_000, "\xff"])
def test_files_without_json_are_refused_by_name(tmp_path, text):
    path = tmp_path / "bad ä.json"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(stiv.InputError, match=r"bad ä\.json"):
        read_edit_script(path)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(stiv.InputError, match=r"none\.json: cannot be read"):
        read_edit_script(tmp_path / "none.json")
