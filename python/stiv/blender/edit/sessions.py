# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the session that solves for all control sets of an assembly."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

import stiv
from stiv.blender.controls.control_set import ControlSet
from stiv.blender.scene.arrays import Floats
from stiv.blender.scene.assembly import Assembly
from stiv.blender.scene.evaluations import RENDER
from stiv.blender.scene.exclusions import find_excluded_triangles
from stiv.blender.settings import EditSettings
from stiv.seams import Seams


def mobilities(count: int, control_sets: Sequence[ControlSet]) -> list[str]:
    """Mobility of each of `count` visible meshes: "fixed", "rigid" or "deformable"."""
    mobility = ["fixed"] * count
    for control_set in control_sets:
        for index in control_set.surfaces:
            mobility[index] = "rigid" if control_set.role == "rigid" else "deformable"
    return mobility


def seams_of(count: int, control_sets: Sequence[ControlSet]) -> list[Seams | None]:
    """Seams that the control sets keep closed, for each of `count` visible meshes."""
    seams: list[Seams | None] = [None] * count
    for control_set in control_sets:
        for index, each in zip(control_set.surfaces, control_set.seams, strict=False):
            seams[index] = each
    return seams


def make_session(
    assembly: Assembly,
    deformation: stiv.Deformation,
    control_sets: Sequence[ControlSet],
    controls: ArrayLike,
    weights: Sequence[Floats],
    settings: EditSettings,
) -> stiv.EditSession:
    """Make a session of all control sets, from their stacked controls, (m, 3).

    deformation: of `deformation_of`. weights: response weights of each control set, (m,) or (m, 3). Raises InputError,
    StartIntersectsError.
    """
    frames, first = [], 0
    for control_set in control_sets:
        if control_set.frame is not None:
            frames.append(stiv.StorageFrame(first, len(control_set.controls), control_set.frame))
        first += len(control_set.controls)
    q = deformation.surface(np.asarray(controls, np.float64))
    options = stiv.EditOptions(
        **settings.shared(),
        pair_separations=body_separations(assembly, settings),
        weights=weights_of_all(weights),
        weight_axes=axes_of_all(control_sets),
        exclude=find_excluded_triangles(settings.excluded, assembly, q, settings.threads),
        single_precision=bool(frames),
        storage=frames,
    )
    try:
        return stiv.EditSession(assembly.surface, deformation, controls, options)
    except stiv.StartIntersectsError as error:
        if intersects_only_in_render(assembly, error):
            error.add_note("only the render intersects; set Guard to Viewport to leave it out")
        raise


def intersects_only_in_render(assembly: Assembly, error: stiv.StartIntersectsError) -> bool:
    """Does the start intersect only in the render?"""
    return len(error.pairs) > 0 and all(_is_only_rendered(assembly, pair) for pair in error.pairs.tolist())


def _is_only_rendered(assembly: Assembly, pair: Sequence[int]) -> bool:
    return any(assembly.face(triangle).evaluation == RENDER for triangle in pair)


def weights_of_all(weights: Sequence[Floats]) -> Floats:
    """Stacked weights of all control sets, (m,); (m, 3) if any set has weights for each axis."""
    if all(each.ndim == 1 for each in weights):
        return np.concatenate(list(weights))
    return np.concatenate([np.broadcast_to(each.reshape(len(each), -1), (len(each), 3)) for each in weights])


def axes_of_all(control_sets: Sequence[ControlSet]) -> Floats | None:
    """Stacked weight axes of all control sets, (m, 3, 3); None if all use the world axes."""
    if all(control_set.weight_axes is None for control_set in control_sets):
        return None
    world = np.eye(3)
    return np.concatenate(
        [
            np.broadcast_to(world, (len(p.controls), 3, 3)) if p.weight_axes is None else p.weight_axes
            for p in control_sets
        ]
    )


def deformation_of(assembly: Assembly, control_sets: Sequence[ControlSet]) -> stiv.Deformation:
    """Deformation of all control sets; other vertices stay where the assembly has them."""
    return stiv.concatenate(
        [(control_set.deformation, _vertices(assembly, control_set)) for control_set in control_sets],
        assembly.positions,
    )


def stack_controls(controls: Sequence[Floats]) -> Floats:
    """Stack the controls of several control sets."""
    return np.concatenate([np.empty((0, 3)), *controls])


def split_controls(controls: Floats, control_sets: Sequence[ControlSet]) -> list[Floats]:
    """Split stacked controls into those of each control set, (m, 3)."""
    return np.split(controls, np.cumsum([len(control_set.controls) for control_set in control_sets])[:-1])


def body_separations(assembly: Assembly, settings: EditSettings) -> dict[tuple[str | int, str | int], float]:
    """Minimum distances of pairs of objects as those of pairs of bodies."""
    bodies: dict[str, list[int]] = {}
    for number, body in enumerate(assembly.surface.bodies):
        bodies.setdefault(body.name, []).append(number)
    return {
        (a, b): distance
        for first, second, distance in settings.pair_separations
        for a in bodies.get(settings.shown_by(first), [])
        for b in bodies.get(settings.shown_by(second), [])
    }


def _vertices(assembly: Assembly, control_set: ControlSet) -> Any:
    return np.concatenate([assembly.range_of(index) for index in control_set.surfaces])
