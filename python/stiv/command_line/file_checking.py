# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks a file of any format, and writes pictures of its findings."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from stiv import InputError
from stiv.checks.findings import FileCheck, Finding, Look, SeamPairs, Untested, merged_seams
from stiv.checks.mesh_check import check_mesh
from stiv.checks.pictures import write_picture
from stiv.command_line.blender_module import quiet_blender, require_blender
from stiv.mesh_files import read_mesh
from stiv.output_files import written_atomically

FrameChoice = tuple[int, int, int] | str  # first, last and step; or "scene" for the range of the scene
MAX_FRAMES = 1_000_000


@dataclass(frozen=True)
class CheckOptions:
    """Options of a check."""

    objects: Collection[str] = ()  #: names of the objects to test; empty: all
    frames: FrameChoice | None = None  #: None: the saved pose
    subframes: int = 1  #: poses per frame step; more follow rotating objects more closely
    pictures: Path | None = None  #: folder of the pictures
    scene: str = "all"  #: name of the scene, in a .blend
    render: bool = False  #: whether to test render levels of any size
    hidden: bool = False  #: whether to test hidden objects
    guard: str = "auto"  #: "viewport", "render" or "both"; "auto": both unless the render is very large


def check_path(
    path: Path, options: CheckOptions | None = None, on_look: Callable[[str], None] = lambda note: None
) -> FileCheck:
    """The results for a file. Calls `on_look` with each pose. Raises InputError if the file cannot be checked."""
    chosen = options or CheckOptions()
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    begin = time.perf_counter()
    is_blend = path.suffix.lower() == ".blend"
    looks = _looks_at_blend(path, chosen) if is_blend else _looks_at_mesh(path, chosen)
    return _summed(path, looks, chosen, on_look, begin)


def _looks_at_mesh(path: Path, options: CheckOptions) -> Iterable[Look]:
    if options.frames is not None:
        raise InputError(f"{path}: a mesh file has no frames")
    mesh = read_mesh(path)
    try:
        yield check_mesh(mesh, options.objects)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def _looks_at_blend(path: Path, options: CheckOptions) -> Iterable[Look]:
    """Yields results for all visible and rendered meshes as Blender evaluates them, and their loose elements."""
    files = require_blender("stiv.blender.scripts.blend_files", path)
    with quiet_blender():
        files.open_blend(path)
    whole = require_blender("stiv.blender.verify.all_scenes", path)
    try:
        whole.check_names(options.scene, options.objects)
        names = whole.scene_names(options.scene)
        for name in names:
            with whole.opened_scene(name) as context:
                for look in _looks_at_scene(path, context, options):
                    yield replace(look, scene=name)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def _looks_at_scene(path: Path, context: Any, options: CheckOptions) -> Iterable[Look]:
    checking, evaluations, whole = (
        require_blender(f"stiv.blender.{name}", path)
        for name in ("verify.frame_check", "scene.guarded_evaluations", "verify.all_scenes")
    )
    if options.hidden:
        whole.unhide_all(context)
    chosen = evaluations.chosen_evaluations(context, options.guard, options.render)
    frames = _frames(path, options, checking, context)
    objects = [name for name in options.objects if name in context.scene.objects]
    if options.objects and not objects:
        return
    note = evaluations.untested_note(context, chosen) if options.guard == "auto" else ""
    for number, look in enumerate(checking.check_frames(context, frames, objects, 0, chosen)):
        yield replace(look, notes=(note, *look.notes)) if note and number == 0 else look


def _frames(path: Path, options: CheckOptions, checking: Any, context: Any) -> list[float]:
    if options.frames is None:
        return []
    chosen = options.frames
    first, last, step = (*checking.scene_frames(context), 1) if isinstance(chosen, str) else chosen
    count = (last - first) * options.subframes // step
    if count >= MAX_FRAMES:
        raise InputError(f"{count} frames, more than the limit of {MAX_FRAMES}")
    frames = [first + number * step / options.subframes for number in range(count + 1)]
    keyed: list[float] = require_blender("stiv.blender.verify.keyed_frames", path).add_subframe_keys(frames)
    return keyed


def _summed(
    path: Path, looks: Iterable[Look], options: CheckOptions, on_look: Callable[[str], None], begin: float
) -> FileCheck:
    found: list[Finding] = []
    seams: list[SeamPairs] = []
    notes: list[str] = []
    frames: set[float] = set()
    pictures: list[str] = []
    names: dict[str, None] = {}
    untested: dict[Untested, None] = {}
    sizes: dict[str, tuple[int, int]] = {}
    shown: set[tuple[str, str]] = set()
    for look in looks:
        if look.to_frame is None:
            names.update(dict.fromkeys(look.shapes.names))
            size = len(look.shapes.positions), len(look.shapes.triangles)
            sizes[look.scene] = max(size, sizes.get(look.scene, (0, 0)))
            frames |= set() if look.frame is None else {look.frame}
            on_look("" if look.frame is None else f"frame {look.frame:g}")
        found += [replace(finding, scene=look.scene) for finding in look.findings]
        notes += [note if note not in notes else "" for note in look.notes]
        seams += look.seams
        untested.update(dict.fromkeys(replace(each, scene=look.scene) for each in look.untested))
        if options.pictures is not None:
            pictures += _pictures(path, look, options.pictures, shown)
    vertices, triangles = (sum(size[k] for size in sizes.values()) for k in range(2))
    scenes = tuple(scene for scene in sizes if scene)
    check = FileCheck(
        path.as_posix(), tuple(names), vertices, triangles, tuple(sorted(frames)), tuple(found), (),
        tuple(note for note in notes if note), "", time.perf_counter() - begin, tuple(pictures), merged_seams(seams),
        scenes, tuple(untested),
    )  # fmt: skip
    return check if len(scenes) > 1 else _without_scene(check)


def _without_scene(check: FileCheck) -> FileCheck:
    """Removes the names of scenes, in a file with one scene."""
    return replace(
        check,
        findings=tuple(replace(each, scene="") for each in check.findings),
        untested=tuple(replace(each, scene="") for each in check.untested),
    )


def _pictures(path: Path, look: Look, folder: Path, shown: set[tuple[str, str]]) -> list[str]:
    """Writes a picture of each pair of objects, at its first intersection."""
    written = []
    for pair in dict.fromkeys(finding.objects for finding in look.findings):
        if pair in shown:
            continue
        shown.add(pair)
        picture = folder / f"{_file_name(path.stem)}-{len(shown)}-{_file_name('-'.join(pair))}.png"
        with written_atomically(picture) as temporary:
            write_picture(temporary, look.shapes, [f for f in look.findings if f.objects == pair], path.name)
        written.append(picture.as_posix())
    return written


def _file_name(text: str) -> str:
    return re.sub(r"[^\w.-]+", "_", text)[:60]
