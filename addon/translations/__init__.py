# SPDX-License-Identifier: GPL-3.0-or-later
"""Translations of the interface: a catalogue for each language, from the English texts of the sources.

Code that composes a text calls `translate("text")` and formats the result; `counted` chooses singular or plural.

tools/interface_messages.py lists the texts to translate; a test compares sources and catalogues.
"""

from __future__ import annotations

import bpy

from . import chinese, errors, german, japanese, korean

CATALOGUES = {
    "de_DE": german.MESSAGES,
    "ja_JP": japanese.MESSAGES,
    "ko_KR": korean.MESSAGES,
    "zh_HANS": chinese.MESSAGES,
}
CONTEXTS = ("*", "Operator")  # Blender looks up labels of buttons in the second, other texts in the first


def dictionary() -> dict[str, dict[tuple[str, str], str]]:
    """All catalogues in Blender's format."""
    return {
        language: {
            (context, english): text
            for english, text in (errors.CATALOGUES[language] | messages).items()
            for context in CONTEXTS
        }
        for language, messages in CATALOGUES.items()
    }


def register() -> None:
    """Register the catalogues."""
    bpy.app.translations.register(__name__, dictionary())


def unregister() -> None:
    """Unregister the catalogues."""
    bpy.app.translations.unregister(__name__)


def counted(count: int, one: str, many: str) -> str:
    """A number and its noun in the language of the interface: `one` is "1 object", `many` is "{} objects"."""
    return translate(one if count == 1 else many).format(f"{count:,}")


def translate(text: str) -> str:
    """A text in the language of the interface; the same text if there is no translation."""
    return str(bpy.app.translations.pgettext_iface(text))


def translate_error(text: object) -> str:
    """The text of an error or a note of the package, in the language of the interface."""
    return errors.in_language(str(text), translate)
