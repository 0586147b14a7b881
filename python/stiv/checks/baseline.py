# SPDX-License-Identifier: GPL-3.0-or-later
"""Baselines: known findings that are accepted, by file, pair of objects and kind, with the number of pairs.

A baseline stores objects instead of faces, because every edit of a mesh changes the indices of its faces. If two
objects intersect in more places than accepted, all of these are reported again.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from stiv import InputError
from stiv.checks.findings import CROSSING, INTERSECTION, FileCheck, Finding
from stiv.json_files import read_json, require_format

SCHEMA, VERSION = "stiv-baseline", 1
MAX_BYTES = 64 * 2**20

Key = tuple[str, str, str, str]  # file, one object, the other, kind
Baseline = Mapping[Key, int]


def read_baseline(path: Path) -> Baseline:
    """Reads a baseline; its files are relative to its folder. Raises InputError naming entry and field."""
    data = read_json(path, MAX_BYTES)
    try:
        return _parsed(data)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def baseline_of(checks: Iterable[FileCheck], folder: Path) -> dict[str, Any]:
    """A baseline that accepts all findings, as JSON data for a file in `folder`."""
    counts: Counter[Key] = Counter()
    for check in checks:
        counts.update(_key(finding, check.file, folder) for finding in (*check.findings, *check.accepted))
    accepted = [
        {"file": file, "objects": [one, other], "kind": kind, "pairs": number}
        for (file, one, other, kind), number in sorted(counts.items())
    ]
    return {"schema": SCHEMA, "version": VERSION, "accepted": accepted}


def without_accepted(check: FileCheck, baseline: Baseline, folder: Path) -> FileCheck:
    """Moves the findings that the baseline (read from `folder`) accepts from `findings` to `accepted`."""
    keys = [_key(finding, check.file, folder) for finding in check.findings]
    counts = Counter(keys)
    known = [counts[key] <= baseline.get(key, 0) for key in keys]
    accepted = tuple(finding for finding, is_known in zip(check.findings, known, strict=True) if is_known)
    left = tuple(finding for finding, is_known in zip(check.findings, known, strict=True) if not is_known)
    return replace(check, findings=left, accepted=accepted)


def _key(finding: Finding, file: str, folder: Path) -> Key:
    one, other = finding.objects
    return Path(os.path.relpath(file, folder)).as_posix(), one, other, finding.kind


def _parsed(data: Any) -> dict[Key, int]:
    accepted = require_format(data, SCHEMA, (VERSION,)).get("accepted")
    if not isinstance(accepted, list):
        raise InputError('the field "accepted" is not a list')
    return dict(_entry(entry, f"accepted {number}") for number, entry in enumerate(accepted))


def _entry(entry: Any, where: str) -> tuple[Key, int]:
    fields = entry if isinstance(entry, dict) else {}
    file, objects, kind, pairs = (fields.get(name) for name in ("file", "objects", "kind", "pairs"))
    if not isinstance(file, str):
        raise InputError(f'{where}: "file" is not the name of a file')
    if not isinstance(objects, list) or len(objects) != 2 or not all(isinstance(name, str) for name in objects):
        raise InputError(f'{where}: "objects" is not a list of two names')
    if kind not in (INTERSECTION, CROSSING):
        raise InputError(f'{where}: "kind" is neither "{INTERSECTION}" nor "{CROSSING}"')
    if not isinstance(pairs, int) or isinstance(pairs, bool) or pairs < 1:
        raise InputError(f'{where}: "pairs" is not a whole number above 0')
    one, other = sorted(objects)
    return (file, one, other, kind), pairs
