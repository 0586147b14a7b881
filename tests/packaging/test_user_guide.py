# SPDX-License-Identifier: GPL-3.0-or-later
"""Labels in the user guide, set in italics, are those of the add-on's interface or of Blender's."""

import re
from pathlib import Path

from tools.interface_messages import messages

ROOT = Path(__file__).resolve().parents[2]
GUIDE = (ROOT / "docs/user_guide.md").read_text(encoding="utf-8")
BLENDERS = {
    "Add-ons", "Adjust Last Operation", "Affect Only", "Align Rotation to Target", "Alt Navigation", "Closest",
    "Cursor", "Curve", "Edge", "Edge Center", "Face", "Face Nearest", "Face Project", "Fixed", "Gimbal", "Grid",
    "Increment", "Individual Origins", "Inverse Kinematics", "Is Viewport", "Item", "Join", "Keymap", "Lattice",
    "Library Override", "Make", "Merge by Distance",
    "Mesh", "Mirror", "Normal", "Object", "Object Gizmos", "Options", "Parent", "Preferences", "Projected",
    "Quad Method", "Realize Instances", "Relative Mirror", "Rest Position", "STIV", "Shape Key Edit Mode",
    "Snap To", "Topology Mirror", "Transform",
    "Transform Modal Map", "Undo", "Vertex", "View", "Volume",
}  # fmt: skip


def test_every_label_of_the_guide_is_in_the_interface() -> None:
    headings = set(re.findall(r"^#+ (.+)$", GUIDE, re.MULTILINE))
    paths = {" ".join(label.split()) for label in re.findall(r"(?<!\*)\*([A-Z][^*]*)\*(?!\*)", GUIDE)} - headings
    labels = {label for path in paths for label in re.split(r" > |: ", path)}
    assert len(labels) > 50
    assert labels <= messages() | BLENDERS | {part for text in messages() for part in text.split(": ")}


def test_every_message_of_the_guide_is_in_the_sources() -> None:
    folders = (ROOT / "addon", ROOT / "python/stiv/blender", ROOT / "native/src")
    paths = [path for folder in folders for path in folder.rglob("*") if path.suffix in (".py", ".cpp")]
    sources = "\n".join(path.read_text(encoding="utf-8") for path in paths)
    table = GUIDE.split("| message | meaning |")[1].split("\n\n")[0]
    rows = re.findall(r"^\| ([^|-][^|]*) \|", table, re.MULTILINE)
    assert len(rows) > 8
    for row in rows:
        for words in re.split(r"\.\.\.|X: Decimate|\"Y\"|Wall", row):
            assert words.strip(" ,:") in sources, row
