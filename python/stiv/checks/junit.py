# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks as JUnit XML for build servers: a test suite for each file, a test case for each frame."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable, Sequence

from stiv.checks.findings import FileCheck, Finding, counted, untested_text, when

LISTED = 50  # pairs in the text of a failure
_NOT_IN_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def junit_xml(checks: Iterable[FileCheck]) -> bytes:
    """The document in UTF-8."""
    root = ElementTree.Element("testsuites", name="stiv check")
    for check in checks:
        _add_suite(root, check)
    ElementTree.indent(root)
    return bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True))


def _add_suite(root: ElementTree.Element, check: FileCheck) -> None:
    cases = _cases(check)
    failures = sum(bool(findings) for _, findings in cases)
    counts = {"tests": len(cases), "failures": failures, "errors": int(bool(check.error))}
    suite = _add(
        root, "testsuite", name=check.file, time=f"{check.seconds:.3f}", **{k: str(v) for k, v in counts.items()}
    )
    for name, findings in cases:
        case = _add(suite, "testcase", classname=check.file, name=name, time=f"{check.seconds / len(cases):.3f}")
        if check.error:
            _add(case, "error", message=check.error)
        elif findings:
            _add(case, "failure", message=_headline(findings)).text = _clean(_listed(findings))
    output = [f"not tested, {untested_text(check.untested)}"] if check.untested else []
    output += [f"accepted by the baseline:\n{_listed(check.accepted)}"] if check.accepted else []
    if output:
        _add(suite, "system-out").text = _clean("\n".join(output))


def _cases(check: FileCheck) -> list[tuple[str, list[Finding]]]:
    names = [f"frame {frame:g}" for frame in check.frames] or ["free of intersections"]
    if len(check.scenes) > 1:
        names = [f'scene "{scene}"' + (f", {name}" if check.frames else "") for scene in check.scenes for name in names]
    found: dict[str, list[Finding]] = {name: [] for name in names}
    for finding in check.findings:
        found.setdefault(when(finding).removesuffix(": ") or names[0], []).append(finding)
    return list(found.items())


def _headline(findings: Sequence[Finding]) -> str:
    pairs = sorted({finding.objects for finding in findings})
    objects = ", ".join(f'"{one}" and "{other}"' for one, other in pairs[:5])
    count = counted(len(findings), sum(finding.triangle_pairs for finding in findings))
    return f"{count}, of {objects}" + (f" and {len(pairs) - 5} more" if len(pairs) > 5 else "")


def _listed(findings: Sequence[Finding]) -> str:
    more = len(findings) - LISTED
    return "\n".join([str(finding) for finding in findings[:LISTED]] + ([f"... and {more} more"] if more > 0 else []))


def _add(parent: ElementTree.Element, tag: str, **attributes: str) -> ElementTree.Element:
    return ElementTree.SubElement(parent, tag, {name: _clean(value) for name, value in attributes.items()})


def _clean(text: str) -> str:
    """Replaces characters that XML cannot contain. The name of an object may contain any."""
    return _NOT_IN_XML.sub("\ufffd", text)
