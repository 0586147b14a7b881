# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks as JSON (python/stiv/schemas/check.schema.json) and as lines for people."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

from stiv.checks.findings import Element, FileCheck, Finding, LeftOut, counted, left_out_text

SCHEMA, VERSION = "stiv-check", 2
LISTED_PAIRS = 100  # of each file, in the report
LISTED_LEFT_OUT = 100  # objects of each file that were not tested, in the report
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
    """The part of the report on one file; seams are counted, and with `with_seams` listed."""
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
        "left_out": [_left_out(each) for each in check.left_out[:LISTED_LEFT_OUT]],
        "left_out_counts": dict(sorted(Counter(each.why for each in check.left_out).items())),
        "notes": list(check.notes),
        "error": check.error,
        "seconds": round(check.seconds, 3),
    }


def summary(check: FileCheck, with_seams: bool = False) -> str:
    """What a file was found to be, one line a fact; with `with_seams` the pairs of faces on seams too."""
    if check.error:
        return f"stiv: {check.file}: {check.error}"
    size = f"{check.vertices:,} vertices, {check.triangles:,} triangles, {len(check.objects)} objects"
    if len(check.scenes) > 1:
        size += f", {len(check.scenes)} scenes"
    if check.frames:
        size += f", {len(check.frames)} frames"
    accepted = f"; {len(check.accepted):,} pairs accepted by the baseline" if check.accepted else ""
    notes = [f"  not tested, {left_out_text(check.left_out)}"] if check.left_out else []
    notes += [f"  note: {note}" for note in check.notes]
    notes += [f"  pairs of faces that touch along seams alone: {check.seam_count:,}"] if check.seams else []
    notes += [f"  seam: {seam}" for each in check.seams for seam in each.findings()] if with_seams else []
    if check.free:
        return "\n".join([f"{check.file}: free of intersections ({size}, {check.seconds:.2f} s){accepted}", *notes])
    lines = [f"{check.file}: {counted(len(check.findings), check.triangle_pairs)} ({size}){accepted}"]
    lines += [f"  {finding}" for finding in check.findings[:SHOWN_PAIRS]]
    more = len(check.findings) - SHOWN_PAIRS
    return "\n".join(lines + ([f"  ... and {more:,} more"] if more > 0 else []) + notes)


def _pair(finding: Finding) -> dict[str, Any]:
    told: dict[str, Any] = {"kind": finding.kind}
    told |= {"first": _element(finding.first), "second": _element(finding.second)}
    told |= {"triangle_pairs": finding.triangle_pairs}
    given: dict[str, Any] = {"scene": finding.scene or None, "rendered": finding.rendered or None}
    given |= {"frame": finding.frame, "to_frame": finding.to_frame, "time": finding.time}
    return told | {name: value for name, value in given.items() if value is not None}


def _left_out(left_out: LeftOut) -> dict[str, Any]:
    told = {"object": left_out.object, "why": left_out.why}
    return told | ({"scene": left_out.scene} if left_out.scene else {})


def _element(element: Element) -> dict[str, Any]:
    return {"object": element.object, "kind": element.kind, "number": element.number}
