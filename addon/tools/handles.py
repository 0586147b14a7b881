# SPDX-License-Identifier: GPL-3.0-or-later
"""The handles of the transform gizmo, with the proportions of Blender's own. NumPy only."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..transform.view import Vector

# Where the faces of a handle turn edge-on: below the first value it is hidden, below the second it fades.
FADING_AXIS = (0.02, 0.1)
FADING_PLANE = (0.175, 0.25)


@dataclass(frozen=True)
class Handle:
    """A handle of the gizmo.

    Attributes:
        kind: "move", "rotate" or "scale".
        axis: index of its axis, or of the normal of its plane; -1 for a handle that faces the view.
        plane: it transforms in the plane perpendicular to `axis`.

    """

    kind: str
    axis: int = -1
    plane: bool = False


AXES = range(3)
# In the order of drawing: later ones are in front.
HANDLES = (
    Handle("scale"),
    *(Handle("scale", axis) for axis in AXES),
    *(Handle("scale", axis, plane=True) for axis in AXES),
    *(Handle("rotate", axis) for axis in AXES),
    Handle("rotate"),
    Handle("move"),
    *(Handle("move", axis) for axis in AXES),
    *(Handle("move", axis, plane=True) for axis in AXES),
)


def opacity(handle: Handle, kinds: frozenset[str], facing: Vector) -> float:
    """The visible fraction of a handle, 0 to 1, in a gizmo with several kinds of transforms.

    facing: (3,) cosines between the view direction and the axes, absolute.
    """
    if handle.kind not in kinds or _is_covered(handle, kinds):
        return 0.0
    if handle.kind == "rotate" or handle.axis < 0:
        return 1.0
    visible = facing[handle.axis] if handle.plane else 1.0 - facing[handle.axis]
    hidden, full = FADING_PLANE if handle.plane else FADING_AXIS
    return 0.0 if visible < hidden else float(min((visible - hidden) / (full - hidden), 1.0))


def _is_covered(handle: Handle, kinds: frozenset[str]) -> bool:
    """Whether handles of another kind take its place."""
    if handle.plane:
        return "rotate" in kinds or (handle.kind == "scale" and "move" in kinds)
    return handle == Handle("scale") and "move" in kinds


def line_range(kind: str, kinds: frozenset[str]) -> tuple[float, float]:
    """Start and end of the line of an arrow from the pivot, in sizes of the gizmo."""
    start, end = 0.2, 1.0
    if kind == "scale":
        return start, end - 0.225 if kinds & {"move", "rotate"} else end
    if "scale" in kinds:
        start = end - 0.125
    if "rotate" in kinds:
        start, end = start + 0.215, end + 0.415
    return start, end


def placement(handle: Handle, start: float = 0.0) -> Vector:
    """(4, 4) matrix from a gizmo that points along z to the handle's direction, shifted by `start` along it."""
    matrix = np.eye(4)
    if handle.axis < 0:
        return matrix
    unit = np.eye(3)
    first, second = unit[(handle.axis + 1) % 3], unit[(handle.axis + 2) % 3]
    if handle.plane:  # the diagonal of the plane; y is its normal
        along, across = (first + second) / np.sqrt(2.0), unit[handle.axis]
    else:
        along, across = unit[handle.axis], second
    matrix[:3, :3] = np.column_stack([np.cross(across, along), across, along])
    matrix[:3, 3] = start * along
    return matrix
