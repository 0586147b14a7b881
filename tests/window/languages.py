# SPDX-License-Identifier: GPL-3.0-or-later
"""Header and status bar of a drag in the languages of the catalogues."""

from __future__ import annotations

import bpy
import extension
import scenes
from playing import INTO_WALL, click, prepared, start
from simulation import Steps, Window

SAYS = {  # for the progress
    "de_DE": "Rechnet {}, Esc hält an",
    "ja_JP": "計算中 {}、Escで停止",
    "ko_KR": "계산 중 {}, Esc로 중지",
    "zh_HANS": "正在求解 {}\N{FULLWIDTH COMMA}Esc停止",
}
REFUSES = {
    "de_DE": "Box: die Skalierung ist null; ändern",
    "ja_JP": "Box: スケールが 0 です。変更してください",
    "ko_KR": "Box: 축척이 0임; 바꾸세요",
    "zh_HANS": "Box: 其缩放为零\N{FULLWIDTH SEMICOLON}请更改",
}


def refusal() -> str:
    """The error of a move of the selection."""
    try:
        bpy.ops.stiv.move("EXEC_DEFAULT", value=(1.0, 0.0, 0.0))
    except RuntimeError as error:
        return str(error)
    return ""


def in_language(code: str) -> object:
    """A scenario: a drag in that language, with a picture of its texts."""

    def scenario(window: Window) -> Steps:
        view = bpy.context.preferences.view
        before = view.language
        view.language, view.use_translate_interface = code, True
        try:
            assert extension.module("translations").translate("Solving {}, Esc stops") == SAYS[code]
            yield from prepared(window, scenes.add_box, "Box")
            yield from start(window)
            yield from window.glide(window.pixel(INTO_WALL))
            window.picture(f"drag_{code}")
            yield from click(window, "ESC")
            bpy.data.objects["Box"].scale.x = 0.0
            assert REFUSES[code] in refusal()
        finally:
            view.language = before

    scenario.__name__ = f"drag_in_{code.lower()}"
    return scenario


LANGUAGES = {scenario.__name__: scenario for scenario in map(in_language, SAYS)}
