# SPDX-License-Identifier: GPL-3.0-or-later
"""A report for an issue, copied to the clipboard: versions, settings, the last messages and the self-test."""

from __future__ import annotations

import platform
import sys
import tomllib
from pathlib import Path

import bpy

from .. import native_module, stiv_blender
from ..operators import reports
from ..translations import translate

MANIFEST = Path(__file__).absolute().parents[1] / "blender_manifest.toml"


class STIV_OT_copy_report(bpy.types.Operator):
    """Copy versions, settings, last messages and a self-test to the clipboard"""

    bl_idname = "stiv.copy_report"
    bl_label = "Copy Report"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Compose and copy."""
        context.window_manager.clipboard = report_text(context)
        self.report({"INFO"}, translate("Copied; paste it into an issue"))
        return {"FINISHED"}


def report_text(context: bpy.types.Context) -> str:
    """The report, always in English."""
    sections = {
        "Versions": versions(),
        "Scene": changed_settings(context.scene.stiv),
        "Objects": [line for ob in context.selected_objects for line in object_lines(ob)],
        "Last messages": list(reports.last_messages),
        "Self-test": [self_test()],
    }
    return "\n\n".join("\n".join([f"{title}:", *(f"  {line}" for line in lines)]) for title, lines in sections.items())


def versions() -> list[str]:
    """STIV, Blender, Python and the system."""
    manifest = tomllib.loads(MANIFEST.read_text(encoding="utf-8"))
    return [
        f"STIV {manifest['version']}; {native_module.problem() or 'the native module is loaded'}",
        f"Blender {bpy.app.version_string}, {bpy.app.build_hash.decode()}, {bpy.app.build_platform.decode()}",
        f"Python {sys.version.split()[0]}, {system()}",
    ]


def system() -> str:
    """The system with its C library and processor. `platform.platform` would start a process."""
    library = " ".join(platform.libc_ver())  # empty except on Linux
    return ", ".join(filter(None, [f"{platform.system()} {platform.release()}", library, platform.machine()]))


def changed_settings(settings: bpy.types.PropertyGroup) -> list[str]:
    """Settings that differ from their defaults, without texts, which may contain names."""
    plain = [p.identifier for p in settings.bl_rna.properties if p.type in ("BOOLEAN", "INT", "FLOAT", "ENUM")]
    return [f"{name}: {plain_value(getattr(settings, name))}" for name in plain if settings.is_property_set(name)]


def plain_value(value: object) -> str:
    """A setting as text, without the rounding errors of single precision."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def object_lines(ob: bpy.types.Object) -> list[str]:
    """Kind, modifiers and changed settings of an object, without its name."""
    modifiers = ", ".join(modifier.type for modifier in ob.modifiers)
    size = f", {len(ob.data.vertices)} vertices" if ob.type == "MESH" else ""
    return [f"{ob.type}{size}; modifiers: {modifiers or 'none'}", *changed_settings(ob.stiv)]


def self_test() -> str:
    """The result of the self-test in a line."""
    if native_module.problem():
        return "not run"
    result = stiv_blender.self_test()
    hashes = f"edits {result.edits}, intersections {result.intersections}, vectors {result.vectors}"
    return f"{'passed' if result.passed else 'FAILED'}: {hashes}"


CLASSES = (STIV_OT_copy_report,)
