# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks one file, of whatever kind, and writes the pictures of what it finds."""

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

FrameChoice = tuple[int, int, int] | str  # first, last and step; or "scene" for the scene's own range
MAX_FRAMES = 1_000_000


@dataclass(frozen=True)
class Choices:
    """What is checked of each file."""

    objects: Collection[str] = ()  #: names to be limited to; empty for all
    frames: FrameChoice | None = None  #: None: the pose that the file was saved in
    subframes: int = 1  #: poses for each step of frames; more follow turning objects more closely
    pictures: Path | None = None  #: folder for them
    scene: str = "all"  #: name of the scene of a .blend
    render: bool = False  #: test what is rendered, however large
    hidden: bool = False  #: test what is hidden too
    guard: str = "auto"  #: test the "viewport", the "render" or "both"; "auto": both unless the render is very large


def check_path(
    path: Path, choices: Choices | None = None, on_look: Callable[[str], None] = lambda note: None
) -> FileCheck:
    """The result for one file; `on_look` is told of each pose. Raises InputError for what cannot be checked."""
    chosen = choices or Choices()
    if not path.is_file():
        raise InputError(f"{path}: there is no such file")
    begin = time.perf_counter()
    is_blend = path.suffix.lower() == ".blend"
    looks = _looks_at_blend(path, chosen) if is_blend else _looks_at_mesh(path, chosen)
    return _summed(path, looks, chosen, on_look, begin)


def _looks_at_mesh(path: Path, choices: Choices) -> Iterable[Look]:
    if choices.frames is not None:
        raise InputError(f"{path}: a mesh file has no frames")
    mesh = read_mesh(path)
    try:
        yield check_mesh(mesh, choices.objects)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def _looks_at_blend(path: Path, choices: Choices) -> Iterable[Look]:
    """Of every mesh that a scene shows or renders, as Blender evaluates it; loose edges and vertices are tested too."""
    files = require_blender("stiv.blender.scripts.blend_files", path)
    with quiet_blender():
        files.open_blend(path)
    whole = require_blender("stiv.blender.verify.all_scenes", path)
    try:
        whole.check_names(choices.scene, choices.objects)
        names = whole.scene_names(choices.scene)
        for name in names:
            with whole.opened_scene(name) as context:
                for look in _looks_at_scene(path, context, choices):
                    yield replace(look, scene=name)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def _looks_at_scene(path: Path, context: Any, choices: Choices) -> Iterable[Look]:
    checking, evaluations, whole = (
        require_blender(f"stiv.blender.{name}", path)
        for name in ("verify.frame_check", "scene.guarded_evaluations", "verify.all_scenes")
    )
    if choices.hidden:
        whole.unhide_all(context)
    chosen = evaluations.chosen_evaluations(context, choices.guard, choices.render)
    frames = _frames(path, choices, checking, context)
    objects = [name for name in choices.objects if name in context.scene.objects]
    if choices.objects and not objects:
        return
    note = evaluations.untested_note(context, chosen) if choices.guard == "auto" else ""
    for number, look in enumerate(checking.check_frames(context, frames, objects, 0, chosen)):
        yield replace(look, notes=(note, *look.notes)) if note and number == 0 else look


def _frames(path: Path, choices: Choices, checking: Any, context: Any) -> list[float]:
    if choices.frames is None:
        return []
    chosen = choices.frames
    first, last, step = (*checking.scene_frames(context), 1) if isinstance(chosen, str) else chosen
    count = (last - first) * choices.subframes // step
    if count >= MAX_FRAMES:
        raise InputError(f"{count} frames; at most {MAX_FRAMES} are checked")
    frames = [first + number * step / choices.subframes for number in range(count + 1)]
    keyed: list[float] = require_blender("stiv.blender.verify.keyed_frames", path).add_subframe_keys(frames)
    return keyed


def _summed(
    path: Path, looks: Iterable[Look], choices: Choices, on_look: Callable[[str], None], begin: float
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
        if choices.pictures is not None:
            pictures += _pictures(path, look, choices.pictures, shown)
    vertices, triangles = (sum(size[k] for size in sizes.values()) for k in range(2))
    scenes = tuple(scene for scene in sizes if scene)
    check = FileCheck(
        path.as_posix(), tuple(names), vertices, triangles, tuple(sorted(frames)), tuple(found), (),
        tuple(note for note in notes if note), "", time.perf_counter() - begin, tuple(pictures), merged_seams(seams),
        scenes, tuple(untested),
    )  # fmt: skip
    return check if len(scenes) > 1 else _without_scene(check)


def _without_scene(check: FileCheck) -> FileCheck:
    """Where there is one scene, nobody asks in which."""
    return replace(
        check,
        findings=tuple(replace(each, scene="") for each in check.findings),
        untested=tuple(replace(each, scene="") for each in check.untested),
    )


def _pictures(path: Path, look: Look, folder: Path, shown: set[tuple[str, str]]) -> list[str]:
    """One picture of each pair of objects, where they are first found to meet."""
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
