# SPDX-License-Identifier: GPL-3.0-or-later
"""The interface in other languages: one catalogue a file, from English texts as they stand in the sources.

Texts that the code puts together itself go through `say("text")`, and are filled in afterwards.

tools/interface_messages.py lists what there is to translate; a test holds sources and catalogues together.
"""

from __future__ import annotations

import bpy

from . import german, japanese

CATALOGUES = {"de_DE": german.MESSAGES, "ja_JP": japanese.MESSAGES}
CONTEXTS = ("*", "Operator")  # labels of buttons are looked up in the second, all else in the first


def dictionary() -> dict[str, dict[tuple[str, str], str]]:
    """All catalogues as Blender takes them."""
    return {
        language: {(context, english): text for english, text in messages.items() for context in CONTEXTS}
        for language, messages in CATALOGUES.items()
    }


def register() -> None:
    """Hand the catalogues to Blender."""
    bpy.app.translations.register(__name__, dictionary())


def unregister() -> None:
    """Take them back."""
    bpy.app.translations.unregister(__name__)


def say(text: str) -> str:
    """A text of the catalogues; the same text where interface texts are not translated."""
    return str(bpy.app.translations.pgettext_iface(text))
