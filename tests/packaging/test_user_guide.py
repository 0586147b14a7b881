# SPDX-License-Identifier: GPL-3.0-or-later
"""Labels in the user guide, set in italics, are those of the add-on's interface or of Blender's."""

import re
from pathlib import Path

from tools.interface_messages import messages

GUIDE = (Path(__file__).resolve().parents[2] / "docs/user_guide.md").read_text(encoding="utf-8")
BLENDERS = {
    "Adjust Last Operation", "Add-ons", "Cursor", "Edge", "Edge Center", "Face", "Gimbal", "Grid", "Increment",
    "Individual Origins", "Is Viewport", "Item", "Keymap", "Lattice", "Library Override", "Make", "Mesh", "Normal",
    "Object", "Parent", "Preferences", "Projected", "STIV", "Transform", "Undo", "Vertex", "View",
}  # fmt: skip


def test_every_label_of_the_guide_is_in_the_interface() -> None:
    headings = set(re.findall(r"^#+ (.+)$", GUIDE, re.MULTILINE))
    paths = {" ".join(label.split()) for label in re.findall(r"(?<!\*)\*([A-Z][^*]*)\*(?!\*)", GUIDE)} - headings
    labels = {label for path in paths for label in re.split(r" > |: ", path)}
    assert len(labels) > 50
    assert labels <= messages() | BLENDERS | {part for text in messages() for part in text.split(": ")}
