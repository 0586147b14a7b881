# SPDX-License-Identifier: GPL-3.0-or-later
"""The session that solves for the parts of an assembly."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

import stiv
from stiv.blender.controls.control_set import Part
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.evaluations import RENDER
from stiv.blender.settings import EditSettings
from stiv.seams import Seams


def mobilities(count: int, parts: Sequence[Part]) -> list[str]:
    """Of each of `count` visible meshes, as the parts let them move."""
    mobility = ["fixed"] * count
    for part in parts:
        for index in part.surfaces:
            mobility[index] = "rigid" if part.role == "rigid" else "deformable"
    return mobility


def seams_of(count: int, parts: Sequence[Part]) -> list[Seams | None]:
    """The seams of each of `count` visible meshes, as the parts keep them closed."""
    seams: list[Seams | None] = [None] * count
    for part in parts:
        for index, each in zip(part.surfaces, part.seams, strict=False):
            seams[index] = each
    return seams


def make_session(
    assembly: Assembly,
    deformation: stiv.Deformation,
    parts: Sequence[Part],
    controls: ArrayLike,
    weights: Sequence[Floats],
    settings: EditSettings,
) -> stiv.EditSession:
    """A session over all parts side by side, from their controls one after the other, (m, 3).

    deformation: of `deformation_of`. weights: response of each part's controls, (m,) or (m, 3)
        each.
    Raises InputError, StartIntersectsError.
    """
    frames, first = [], 0
    for part in parts:
        if part.frame is not None:
            frames.append(stiv.StorageFrame(first, len(part.controls), part.frame))
        first += len(part.controls)
    q = deformation.surface(np.asarray(controls, np.float64))
    options = stiv.EditOptions(
        **settings.shared(),
        pair_separations=pair_separations_of(assembly, settings),
        weights=weights_of_all(weights),
        weight_axes=axes_of_all(parts),
        exclude=settings.excluded.triangles(assembly, q, settings.threads),
        single_precision=bool(frames),
        storage=frames,
    )
    try:
        return stiv.EditSession(assembly.surface, deformation, controls, options)
    except stiv.StartIntersectsError as error:
        if meets_only_rendered(assembly, error):
            error.add_note("it does so only when rendered; set Guard to Viewport to leave the render out")
        raise


def meets_only_rendered(assembly: Assembly, error: stiv.StartIntersectsError) -> bool:
    """Does a start intersect in the render alone?"""
    return len(error.pairs) > 0 and all(_is_only_rendered(assembly, pair) for pair in error.pairs.tolist())


def _is_only_rendered(assembly: Assembly, pair: Sequence[int]) -> bool:
    return any(assembly.face(triangle).evaluation == RENDER for triangle in pair)


def weights_of_all(weights: Sequence[Floats]) -> Floats:
    """Weights of each part, (m,) or (m, 3), one after the other; (m, 3) if those of any part are."""
    if all(each.ndim == 1 for each in weights):
        return np.concatenate(list(weights))
    return np.concatenate([np.broadcast_to(each.reshape(len(each), -1), (len(each), 3)) for each in weights])


def axes_of_all(parts: Sequence[Part]) -> Floats | None:
    """The axes, (m, 3, 3), of the weights of all parts; None: x, y, z for all."""
    if all(part.weight_axes is None for part in parts):
        return None
    world = np.eye(3)
    return np.concatenate(
        [np.broadcast_to(world, (len(p.controls), 3, 3)) if p.weight_axes is None else p.weight_axes for p in parts]
    )


def deformation_of(assembly: Assembly, parts: Sequence[Part]) -> stiv.Deformation:
    """All parts side by side; what none of them moves stays where the assembly has it."""
    return stiv.concatenate([(part.deformation, _vertices(assembly, part)) for part in parts], assembly.positions)


def stacked(controls: Sequence[Floats]) -> Floats:
    """Controls of several parts one after the other."""
    return np.concatenate([np.empty((0, 3)), *controls])


def split(controls: Floats, parts: Sequence[Part]) -> list[Floats]:
    """The controls of each part, (m, 3), out of those of all, one after the other."""
    return np.split(controls, np.cumsum([len(part.controls) for part in parts])[:-1])


def pair_separations_of(assembly: Assembly, settings: EditSettings) -> dict[tuple[str | int, str | int], float]:
    """The separations of pairs of objects as those of their bodies."""
    bodies: dict[str, list[int]] = {}
    for number, body in enumerate(assembly.surface.bodies):
        bodies.setdefault(body.name, []).append(number)
    return {
        (a, b): distance
        for first, second, distance in settings.pair_separations
        for a in bodies.get(settings.shown_by(first), [])
        for b in bodies.get(settings.shown_by(second), [])
    }


def _vertices(assembly: Assembly, part: Part) -> Any:
    return np.concatenate([assembly.range_of(index) for index in part.surfaces])
