# SPDX-License-Identifier: GPL-3.0-or-later
"""Views for the tests of the transform mathematics, built from eye and target."""

import numpy as np

from stiv_addon.modal.typed_numbers import TypedNumber, TypedValues
from stiv_addon.transform.view import View

SIZE = (800, 600)


def typed(*texts: str) -> TypedValues:
    """Numbers typed in sequence, as with Tab."""
    numbers = [TypedNumber(text.lstrip("-"), text.startswith("-")) for text in texts]
    return TypedValues((*numbers, *[TypedNumber()] * (3 - len(numbers))), len(numbers) - 1)


def looking(eye: tuple, target: tuple = (0.0, 0.0, 0.0), *, parallel: bool = False) -> View:
    """A view from `eye` to `target`, z upwards (y when looking along z)."""
    eye, target = np.array(eye, float), np.array(target, float)
    back = (eye - target) / np.linalg.norm(eye - target)
    up = np.array([0.0, 1.0, 0.0]) if abs(back[2]) > 0.99 else np.array([0.0, 0.0, 1.0])
    right = np.cross(up, back) / np.linalg.norm(np.cross(up, back))
    view = np.eye(4)
    view[:3, :3] = np.stack([right, np.cross(back, right), back])
    view[:3, 3] = -view[:3, :3] @ eye
    return View((_parallel() if parallel else _perspective()) @ view, SIZE)


def _perspective(near: float = 0.1, far: float = 1000.0) -> np.ndarray:
    matrix = np.zeros((4, 4))
    matrix[0, 0], matrix[1, 1] = 1.5, 1.5 * SIZE[0] / SIZE[1]
    matrix[2, 2:] = -(far + near) / (far - near), -2.0 * far * near / (far - near)
    matrix[3, 2] = -1.0
    return matrix


def _parallel(extent: float = 5.0, depth: float = 1000.0) -> np.ndarray:
    return np.diag([1.0 / extent, SIZE[0] / SIZE[1] / extent, -1.0 / depth, 1.0])


VIEWS = {
    "top": looking((0, 0, 10), parallel=True),
    "corner parallel": looking((6, -5, 4), parallel=True),
    "corner perspective": looking((6, -5, 4)),
    "below perspective": looking((-3, 4, -7), (1, 0, 0)),
}
