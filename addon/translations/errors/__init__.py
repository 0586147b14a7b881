# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the package in the language of the interface.

The package raises English texts in which names and numbers are filled in. Templates with {} for these find the fixed
words; a text that no template fits stays English.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Callable

from . import chinese, german, japanese, korean

CATALOGUES = {
    "de_DE": german.MESSAGES,
    "ja_JP": japanese.MESSAGES,
    "ko_KR": korean.MESSAGES,
    "zh_HANS": chinese.MESSAGES,
}
# Words within messages that Blender's own translation has, with a capital.
BLENDERS = {"curve", "curves", "lattice", "location", "mesh", "metaball", "rotation", "scale", "surface", "text"}
_MODIFIER = re.compile(r'([^":]+) "(.+?)" (.+)', re.DOTALL)  # its type, its name, and why it is refused

Translate = Callable[[str], str]


def in_language(text: str, translate: Translate) -> str:
    """A message in the language of `translate`, which translates templates. A name before a colon stays."""
    starts = [0, *(found.end() for found in re.finditer(": ", text))]
    for start in starts:
        filled = _filled(text[start:], translate) or _modifier(text[start:], translate)
        if filled:
            return text[:start] + filled
    return text


def _filled(text: str, translate: Translate) -> str:
    """The translation of the template that fits a text, filled in; empty if none fits."""
    for pattern, template in _patterns():
        found = pattern.fullmatch(text)
        if found is not None and (target := translate(template)) != template:
            return target.format(*(_part(part, translate) for part in found.groups()))
    return ""


def _modifier(text: str, translate: Translate) -> str:
    """The refusal of a modifier; empty for other texts."""
    found = _MODIFIER.fullmatch(text)
    reason = _filled(found[3], translate) if found is not None else ""
    return f'{translate(found[1])} "{found[2]}" {reason}' if found is not None and reason else ""


def _part(part: str, translate: Translate) -> str:
    """A part that varies: a name, a number, a word of Blender, or a message within the message."""
    if part in BLENDERS:
        return translate(part.capitalize())
    return _filled(part, translate) or part


@functools.cache
def _patterns() -> tuple[tuple[re.Pattern[str], str], ...]:
    """A pattern for each template, those with the most fixed letters first."""
    templates = sorted(german.MESSAGES, key=lambda template: -len(template.replace("{}", "")))
    return tuple((re.compile(re.escape(each).replace(r"\{\}", "(.*)"), re.DOTALL), each) for each in templates)
