# SPDX-License-Identifier: GPL-3.0-or-later
"""From the state of a drag to a translation, rotation or scaling and its 4x4 world matrix. NumPy only."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ..modal.state import State
from ..modal.typed_numbers import Read
from .frame import Frame
from .rotation import Rotation, requested_rotation
from .scaling import Scaling, requested_scaling
from .snapping import Snap
from .translation import Translation, requested_translation

Transform = Translation | Rotation | Scaling
Requested = Callable[[State, Frame, Read, Snap | None], Transform]

REQUESTED: Mapping[str, Requested] = {
    "move": requested_translation,
    "rotate": requested_rotation,
    "scale": requested_scaling,
}


def requested_transform(state: State, frame: Frame, readers: Mapping[str, Read], snap: Snap | None) -> Transform:
    """The transform that a state requests. `readers` by kind read typed text. ValueError for invalid text."""
    return REQUESTED[state.kind](state, frame, readers[state.kind], snap)
