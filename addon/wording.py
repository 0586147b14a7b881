# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts that the code puts together itself, in the language that Blender shows: `say("text")`, filled in afterwards."""

from __future__ import annotations

import bpy


def say(text: str) -> str:
    """A text of the catalogues; the same text where interface texts are not translated."""
    return str(bpy.app.translations.pgettext_iface(text))
