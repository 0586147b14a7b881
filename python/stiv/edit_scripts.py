# SPDX-License-Identifier: GPL-3.0-or-later
"""Edit scripts: JSON files with steps, each a selection and an operator. docs/edit_scripts.md describes the format."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from stiv import InputError
from stiv.json_files import read_json, require_format

SCHEMA, VERSION = "stiv-edits", 1
MAX_EDITS = 1_000_000
MAX_BYTES = 64 * 2**20
TRANSFORMS = {
    "move": {"value": 3},
    "scale": {"value": 3},
    "rotate": {"angle": 1, "axis": 3},
}  #: all values are required
CONSTRAINT = "constraint_axis"  #: optional for all of them: three flags, the world axes that contact may not leave
RESHAPES: dict[str, dict[str, type]] = {
    "contract": {"steps": int, "smoothing": float, "until_free": bool},
    "expand": {"amount": float},
    "settle": {"rounds": int, "smoothness": float},
    "repair": {"max_deviation": float, "weld": bool},
}  #: each value is optional
_STEP_KEYS = {"operator", "mode", "objects", "points", "values", "repeat", "settings"}


@dataclass(frozen=True)
class EditStep:
    """One operator call on a selection.

    operator  one of TRANSFORMS or RESHAPES
    points    in Edit Mode, the indices of cage vertices or of points; None: all
    values    the operator's properties, in world units and radians
    settings  the add-on's settings for this step by name
    """

    operator: str
    mode: str
    objects: tuple[str, ...]
    values: Mapping[str, Any]
    points: tuple[int, ...] | None = None
    repeat: int = 1
    settings: Mapping[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class EditScript:
    """The steps of a script, with the settings of all steps."""

    steps: tuple[EditStep, ...]
    settings: Mapping[str, Any] = field(default_factory=dict)
    description: str = ""

    def edits(self) -> Iterator[EditStep]:
        """Yields a step for each edit, as often as the step repeats."""
        for step in self.steps:
            for _ in range(step.repeat):
                yield step

    def __len__(self) -> int:
        """Number of edits, with repetitions."""
        return sum(step.repeat for step in self.steps)


def read_edit_script(path: Path | str) -> EditScript:
    """Reads a script. Raises InputError naming file, step and field."""
    path = Path(path)
    data = read_json(path, MAX_BYTES)
    try:
        return parse_edit_script(data)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def parse_edit_script(data: object) -> EditScript:
    """The script from parsed JSON. Raises InputError naming step and field."""
    fields = require_format(data, SCHEMA, (VERSION,))
    steps = fields.get("steps")
    if not isinstance(steps, list):
        raise InputError('the field "steps" is not a list')
    script = EditScript(
        tuple(_step(step, f"step {number}") for number, step in enumerate(steps)),
        _mapping(fields.get("settings", {}), "settings"),
        str(fields.get("description", "")),
    )
    if len(script) > MAX_EDITS:
        raise InputError(f"{len(script)} edits, more than the limit of {MAX_EDITS}")
    return script


def _step(data: object, where: str) -> EditStep:
    step = _mapping(data, where)
    unknown = sorted(set(step) - _STEP_KEYS)
    if unknown:
        raise InputError(f'{where}: unknown field "{unknown[0]}"; the fields are {", ".join(sorted(_STEP_KEYS))}')
    operator = step.get("operator")
    if not isinstance(operator, str) or operator not in (*TRANSFORMS, *RESHAPES):
        raise InputError(f"{where}: operator {operator!r} is none of {', '.join((*TRANSFORMS, *RESHAPES))}")
    mode = step.get("mode", "OBJECT")
    if mode not in ("OBJECT", "EDIT"):
        raise InputError(f'{where}: mode {mode!r} is neither "OBJECT" nor "EDIT"')
    repeat = step.get("repeat", 1)
    if not _is_index(repeat) or repeat < 1:
        raise InputError(f"{where}: repeat {repeat!r} is not a whole number above 0")
    return EditStep(
        operator,
        mode,
        _objects(step.get("objects"), mode, where),
        _values(step.get("values"), operator, where)
        if operator in TRANSFORMS
        else _choices(step.get("values", {}), operator, where),
        _points(step.get("points", "all"), mode, where),
        repeat,
        _mapping(step.get("settings", {}), f"{where}: settings"),
    )


def _objects(data: object, mode: str, where: str) -> tuple[str, ...]:
    if not isinstance(data, list) or not data or not all(isinstance(name, str) for name in data):
        raise InputError(f'{where}: "objects" is not a list of object names')
    if mode == "EDIT" and len(data) != 1:
        raise InputError(f"{where}: Edit Mode takes one object, not {len(data)}")
    return tuple(data)


def _points(data: object, mode: str, where: str) -> tuple[int, ...] | None:
    if data == "all":
        return None
    if mode != "EDIT":
        raise InputError(f'{where}: "points" are selected in Edit Mode only')
    if not isinstance(data, list) or not all(_is_index(index) for index in data):
        raise InputError(f'{where}: "points" is neither "all" nor a list of indices')
    return tuple(data)


def _values(data: object, operator: str, where: str) -> dict[str, Any]:
    values = _mapping(data, f"{where}: values")
    wanted = TRANSFORMS[operator]
    if set(values) - {CONSTRAINT} != set(wanted):
        raise InputError(f"{where}: {operator} takes the values {', '.join(wanted)}, not {', '.join(values) or 'none'}")
    numbers: dict[str, Any] = {name: _numbers(values[name], n, f"{where}: {name}") for name, n in wanted.items()}
    return numbers | ({CONSTRAINT: _flags(values[CONSTRAINT], where)} if CONSTRAINT in values else {})


def _flags(data: object, where: str) -> tuple[bool, ...]:
    if not isinstance(data, list) or len(data) != 3 or not all(isinstance(flag, bool) for flag in data):
        raise InputError(f"{where}: {CONSTRAINT}: three of true or false expected, not {data!r}")
    return tuple(data)


def _choices(data: object, operator: str, where: str) -> dict[str, Any]:
    values = _mapping(data, f"{where}: values")
    known = RESHAPES[operator]
    for name, value in values.items():
        if name not in known:
            raise InputError(f'{where}: {operator} takes the values {", ".join(known)}, not "{name}"')
        fits = {bool: isinstance(value, bool), int: _is_index(value), float: _is_number(value)}[known[name]]
        if not fits:
            kind = {bool: "true or false", int: "a whole number", float: "a finite number"}[known[name]]
            raise InputError(f"{where}: {name}: {kind} expected, not {value!r}")
    return values


def _numbers(data: object, count: int, where: str) -> float | tuple[float, ...]:
    numbers: list[Any] = data if isinstance(data, list) else [data]
    if len(numbers) != count or not all(_is_number(number) for number in numbers):
        raise InputError(f"{where}: {count} finite number{'s' * (count > 1)} expected, not {data!r}")
    return tuple(map(float, numbers)) if count > 1 else float(numbers[0])


def _mapping(data: object, where: str) -> dict[str, Any]:
    if not isinstance(data, dict):
        raise InputError(f"{where}: not an object with named fields")
    return data


def _is_number(value: object) -> bool:
    return (
        isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300 and math.isfinite(value)
    )


def _is_index(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value < 2**31
