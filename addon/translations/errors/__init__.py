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


def in_language(text: str, translate: Translate, fill: Callable[..., str] = str.format) -> str:
    """A message in the language of `translate`, which translates templates. A name before a colon stays.

    fill: puts names and numbers into a template.
    """
    for start in [0, *(found.end() for found in re.finditer(": ", text))]:
        parts: list[str] = []
        template = _template(text[start:], translate, parts) or _modifier(text[start:], translate, parts)
        if template:
            names = [f"{_placeholder(name, parts)}: " for name in text[:start].split(": ")[:-1]]
            return fill("".join([*names, template]), *parts)
    return text


def _template(text: str, translate: Translate, parts: list[str]) -> str:
    """The translated template that fits a text, whose parts are added to `parts`; empty if none fits."""
    for pattern, template in _patterns():
        found = pattern.fullmatch(text)
        if found is not None:
            return translate(template).format(*(_part(part, translate, parts) for part in found.groups()))
    return ""


def _modifier(text: str, translate: Translate, parts: list[str]) -> str:
    """The template of a modifier's refusal; empty for other texts."""
    found = _MODIFIER.fullmatch(text)
    reason = _template(found[3], translate, parts) if found is not None else ""
    if found is None or not reason:
        return ""
    return f'{_placeholder(translate(found[1]), parts)} "{_placeholder(found[2], parts)}" {reason}'


def _part(part: str, translate: Translate, parts: list[str]) -> str:
    """The placeholder of a name, a number or a word of Blender, or the template of a message within the message."""
    if part in BLENDERS:
        return _placeholder(translate(part.capitalize()), parts)
    return _template(part, translate, parts) or _placeholder(part, parts)


def _placeholder(part: str, parts: list[str]) -> str:
    """Add a part; returns its {number} for a template, because translations change the order."""
    parts.append(part)
    return f"{{{len(parts) - 1}}}"


@functools.cache
def _patterns() -> tuple[tuple[re.Pattern[str], str], ...]:
    """A pattern for each template, those with the most fixed letters first."""
    templates = sorted(german.MESSAGES, key=lambda template: -len(template.replace("{}", "")))
    return tuple((re.compile(re.escape(each).replace(r"\{\}", "(.*)"), re.DOTALL), each) for each in templates)
