# SPDX-License-Identifier: GPL-3.0-or-later
"""From a drag to a 4x4 world matrix: translation, rotation, scaling. NumPy only."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ..modal.state import State
from ..modal.typed_numbers import Read
from .frame import Frame
from .rotation import Rotation, measure_rotation
from .scaling import Scaling, measure_scaling
from .snapping import Snap
from .translation import Translation, measure_translation

Transform = Translation | Rotation | Scaling
Measure = Callable[[State, Frame, Read, Snap | None], Transform]

MEASURES: Mapping[str, Measure] = {
    "move": measure_translation,
    "rotate": measure_rotation,
    "scale": measure_scaling,
}


def measure(state: State, frame: Frame, readers: Mapping[str, Read], snap: Snap | None) -> Transform:
    """The transform of a state; `readers` read typed text, by kind. ValueError for text that is no value."""
    return MEASURES[state.kind](state, frame, readers[state.kind], snap)
