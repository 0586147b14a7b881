# SPDX-License-Identifier: GPL-3.0-or-later
"""Resolves an animation by the keyframes of its bones and objects: no mesh is baked, constraints stay."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import bpy

from stiv import InputError
from stiv.blender.animation.animated_parts import Limits, find_animated_parts
from stiv.blender.animation.clip import Clip
from stiv.blender.animation.correcting import Correction, Corrector, moments_of
from stiv.blender.animation.corrective_keys import Corrective, write_correctives
from stiv.blender.animation.keying import check_curves, key_corrections
from stiv.blender.animation.tracks import read_tracks
from stiv.blender.controls.joint_regions import Regions
from stiv.blender.settings import EditSettings
from stiv.blender.verify.frame_check import check_frames
from stiv.blender.verify.keyed_frames import add_subframe_keys


@dataclass(frozen=True)
class RigOptions:
    """Limits of a correction.

    Attributes:
        bones: patterns of bones and objects that may change, each with its largest angle in degrees or None; empty: all
            that keyframes move.
        turn: largest change of an angle, degrees.
        move: largest change of a location along an axis, in its units; infinite: a tenth of the surface's size.
        acceleration: largest acceleration, divided by that of the input.
        hold: names of objects that keep their animation.
        allow_shapes: correct frames that bones cannot by shape keys.
    """

    bones: Mapping[str, float | None] = field(default_factory=dict)
    turn: float = 30.0
    move: float = float("inf")
    acceleration: float = 1.1
    hold: Collection[str] = ()
    allow_shapes: bool = False


def resolve_rig(
    context: bpy.types.Context,
    frames: Sequence[int],
    options: RigOptions,
    settings: EditSettings,
    on_frame: Callable[[str], None] = lambda status: None,
) -> tuple[Clip, Correction]:
    """Correct the open scene in memory and write keyframes, unless frames are left. Raises InputError by name."""
    if len(frames) < 2 or any(after - before != 1 for before, after in pairwise(frames)):
        raise InputError("--write rig needs at least two frames in steps of 1")
    clip = _read_clip(context, frames, options, settings)
    check_curves(clip.parts)
    corrector = Corrector(clip, frames, settings, options.acceleration, on_frame)
    correction = corrector.correct()
    correctives: list[Corrective] = []
    if correction.failed and options.allow_shapes:
        correction, correctives = corrector.correct_by_shapes(correction)
    if not correction.failed:
        key_corrections(clip, frames, correction.values)
        write_correctives(correctives)
    clip.restore(frames[0])
    return clip, correction


def remaining(
    context: bpy.types.Context,
    corrected: Clip,
    frames: Sequence[int],
    options: RigOptions,
    settings: EditSettings,
    evaluations: Sequence[str],
) -> list[str]:
    """Intersections of the opened result, at frames, halfway between them, and of the motion between these.

    corrected: the clip before it was written. Skin that bones bend is tested against itself in the viewport, without
    the faces around joints.
    """
    clip = _read_clip(context, frames, options, settings, corrected.regions)
    moments = add_subframe_keys(moments_of(frames))
    bad = Corrector(clip, frames, settings, options.acceleration).intersecting(moments)
    looks = check_frames(context, moments, evaluations=evaluations)
    found = [str(each) for look in looks for each in look.findings if frozenset(each.objects) not in clip.divided]
    return found or [f"frame {moment:g}: the skin intersects itself" for moment in bad]


def _read_clip(
    context: bpy.types.Context,
    frames: Sequence[int],
    options: RigOptions,
    settings: EditSettings,
    regions: Sequence[Regions] = (),
) -> Clip:
    limits = Limits(options.turn, options.move, options.bones, options.hold)
    parts = find_animated_parts(context.scene, frames, limits)
    moments = moments_of(frames)
    return Clip(context, parts, read_tracks(context, moments), moments, settings.joint_region, regions)


def with_options(settings: EditSettings, separation: float, joint_region: float | None) -> EditSettings:
    """Settings with a minimum distance (0 keeps theirs) and a region at joints (None keeps theirs)."""
    return replace(
        settings,
        separation=separation or settings.separation,
        joint_region=settings.joint_region if joint_region is None else joint_region,
    )
