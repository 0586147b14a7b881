# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks as JSON (python/stiv/schemas/check.schema.json) and as text."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

from stiv.checks.findings import Element, FileCheck, Finding, Untested, counted, untested_text

SCHEMA, VERSION = "stiv-check", 2
LISTED_PAIRS = 100  # of each file, in the report
LISTED_UNTESTED = 100  # objects of each file that were not tested, in the report
SHOWN_PAIRS = 10  # of each file, on the terminal


def report_of(checks: Sequence[FileCheck], with_seams: bool = False) -> dict[str, Any]:
    """The report on all files."""
    return {
        "schema": SCHEMA,
        "version": VERSION,
        "free": all(check.free for check in checks),
        "intersections": sum(len(check.findings) for check in checks),
        "triangle_pairs": sum(check.triangle_pairs for check in checks),
        "files": [file_report(check, with_seams) for check in checks],
    }


def file_report(check: FileCheck, with_seams: bool = False) -> dict[str, Any]:
    """The report on one file. `with_seams` lists seams, which are otherwise only counted."""
    listed = {"seam_pairs": [_pair(seam) for each in check.seams for seam in each.findings()]} if with_seams else {}
    return listed | {
        "file": check.file,
        "objects": list(check.objects),
        "vertices": check.vertices,
        "triangles": check.triangles,
        "frames": list(check.frames),
        "free": check.free,
        "intersections": len(check.findings),
        "triangle_pairs": check.triangle_pairs,
        "accepted": len(check.accepted),
        "seams": check.seam_count,
        "pairs": [_pair(finding) for finding in check.findings[:LISTED_PAIRS]],
        "pictures": list(check.pictures),
        "scenes": list(check.scenes),
        "untested": [_untested(each) for each in check.untested[:LISTED_UNTESTED]],
        "untested_counts": dict(sorted(Counter(each.reason for each in check.untested).items())),
        "notes": list(check.notes),
        "error": check.error,
        "seconds": round(check.seconds, 3),
    }


def summary(check: FileCheck, with_seams: bool = False) -> str:
    """The results for one file as text; `with_seams` includes the pairs of faces on seams."""
    if check.error:
        return f"stiv: {check.file}: {check.error}"
    objects = "1 object" if len(check.objects) == 1 else f"{len(check.objects)} objects"
    size = f"{check.vertices:,} vertices, {check.triangles:,} triangles, {objects}"
    if len(check.scenes) > 1:
        size += f", {len(check.scenes)} scenes"
    if check.frames:
        size += f", {len(check.frames)} frames"
    accepted = f"; {len(check.accepted):,} pairs accepted by the baseline" if check.accepted else ""
    notes = [f"  not tested, {untested_text(check.untested)}"] if check.untested else []
    notes += [f"  note: {note}" for note in check.notes]
    notes += [f"  pairs of faces that touch only along seams: {check.seam_count:,}"] if check.seams else []
    notes += [f"  seam: {seam}" for each in check.seams for seam in each.findings()] if with_seams else []
    if check.free:
        return "\n".join([f"{check.file}: free of intersections ({size}, {check.seconds:.2f} s){accepted}", *notes])
    lines = [f"{check.file}: {counted(len(check.findings), check.triangle_pairs)} ({size}){accepted}"]
    lines += [f"  {finding}" for finding in check.findings[:SHOWN_PAIRS]]
    more = len(check.findings) - SHOWN_PAIRS
    return "\n".join(lines + ([f"  ... and {more:,} more"] if more > 0 else []) + notes)


def _pair(finding: Finding) -> dict[str, Any]:
    optional = {
        "scene": finding.scene or None,
        "rendered": finding.rendered or None,
        "frame": finding.frame,
        "to_frame": finding.to_frame,
        "time": finding.time,
    }
    return {
        "kind": finding.kind,
        "first": _element(finding.first),
        "second": _element(finding.second),
        "triangle_pairs": finding.triangle_pairs,
        **{name: value for name, value in optional.items() if value is not None},
    }


def _untested(untested: Untested) -> dict[str, Any]:
    data = {"object": untested.object, "reason": untested.reason}
    return data | ({"scene": untested.scene} if untested.scene else {})


def _element(element: Element) -> dict[str, Any]:
    return {"object": element.object, "kind": element.kind, "number": element.number}
