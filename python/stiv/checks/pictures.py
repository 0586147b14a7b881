# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of findings: both objects, and a close-up with the intersecting faces in red. Needs no display.

`raster` draws the pixels. matplotlib, from the extra `pictures`, adds text and writes the file.
"""

from __future__ import annotations

import importlib.util
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stiv import InputError
from stiv.checks.findings import Finding, Shapes, when
from stiv.checks.raster import Camera, Floats, camera_at, draw

SIZE = 480  # pixels of each of the two views
_COLORS = np.array([[0.45, 0.62, 0.85], [0.95, 0.78, 0.45]])
_MARKED = np.array([0.90, 0.10, 0.12])
_DIRECTION = np.array([0.55, -0.75, 0.5])
_HIDDEN = 0.55  # opacity of marked faces behind others
_CLOSE = 6.0  # height of the close-up, in sizes of the first pair of marked faces


def require_matplotlib() -> None:
    """Raises InputError if matplotlib is not installed. Called before any work is done."""
    if importlib.util.find_spec("matplotlib") is None:
        raise InputError("pictures need matplotlib, which is not installed: `pip install stiv[pictures]`")


def write_picture(path: Path, shapes: Shapes, findings: Sequence[Finding], title: str) -> None:
    """Writes a PNG file of the findings between two objects in one pose."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    one, other = findings[0].objects
    figure = Figure(figsize=(2 * SIZE / 100 + 0.2, SIZE / 100 + 0.9), dpi=100)
    FigureCanvasAgg(figure)
    for place, image in enumerate(views(shapes, findings)):
        axes = figure.add_axes((0.01 + 0.495 * place, 0.01, 0.485, SIZE / (SIZE + 90)))
        axes.imshow(image)
        axes.set_axis_off()
    first = f"{findings[0].first} - {findings[0].second}"
    caption = f"{when(findings[0])}{len(findings)} intersecting pairs, in red; the first: {first}"
    figure.text(0.01, 0.97, _plain(f'{title}: "{one}" (blue), "{other}" (yellow)'), va="top", fontsize=10)
    figure.text(0.01, 0.92, _plain(caption), va="top", fontsize=8)
    figure.savefig(path, format="png")


def views(shapes: Shapes, findings: Sequence[Finding]) -> tuple[Floats, Floats]:
    """Both objects, and a close-up of the first finding: two images, (SIZE, SIZE, 3)."""
    one, other = findings[0].objects
    colors, kept = _colors(shapes, one, other)
    marked = _marked(shapes, findings)
    corners = shapes.positions[shapes.triangles]
    whole = camera_at(corners[kept].reshape(-1, 3), _DIRECTION)
    first = corners[_marked(shapes, findings[:1])].reshape(-1, 3)
    close = camera_at(first if len(first) else corners[kept].reshape(-1, 3), _DIRECTION, _CLOSE)
    if close.height > whole.height:
        close = Camera(whole.axes, close.centre, whole.height)
    image, close_image = (_view(shapes, kept, marked, colors, camera) for camera in (whole, close))
    return image, close_image


def _view(shapes: Shapes, kept: NDArray[np.bool_], marked: NDArray[np.bool_], colors: Floats, camera: Camera) -> Floats:
    size = (SIZE, SIZE)
    image, depth = draw(shapes.positions, shapes.triangles[kept], colors[kept], camera, size)
    red = np.broadcast_to(_MARKED, (int(marked.sum()), 3))
    marks, near = draw(shapes.positions, shapes.triangles[marked], red, camera, size)
    seen = np.isfinite(near)
    strength = np.where(near >= depth - 1e-6 * camera.height, 1.0, _HIDDEN)[seen][:, None]
    image[seen] = strength * marks[seen] + (1 - strength) * image[seen]
    return image


def _colors(shapes: Shapes, one: str, other: str) -> tuple[Floats, NDArray[np.bool_]]:
    """Color of each triangle, (F, 3), and whether it belongs to one of the two objects, (F,)."""
    names = np.array(shapes.names)[shapes.owner] if len(shapes.owner) else np.zeros(0, str)
    return _COLORS[(names == other).astype(int) * int(one != other)], (names == one) | (names == other)


def _marked(shapes: Shapes, findings: Sequence[Finding]) -> NDArray[np.bool_]:
    """Whether each triangle belongs to a face of the findings, (F,)."""
    index = {name: place for place, name in enumerate(shapes.names)}
    faces = {
        (index[each.object], each.number)
        for finding in findings
        for each in (finding.first, finding.second)
        if each.kind in ("face", "triangle")
    }
    rows = np.array(sorted(faces), np.int64).reshape(-1, 2)
    stride = max(int(shapes.number.max(initial=0)), int(rows[:, 1].max(initial=0))) + 1
    return np.isin(shapes.owner * np.int64(stride) + shapes.number, rows[:, 0] * stride + rows[:, 1])


def _plain(text: str, length: int = 130) -> str:
    """Escapes the characters that matplotlib reads as formulas, and shortens the text."""
    cut = text if len(text) <= length else text[: length - 3] + "..."
    return cut.replace("$", r"\$")
