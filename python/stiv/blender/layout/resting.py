# SPDX-License-Identifier: GPL-3.0-or-later
"""Lets a rigid body fall until it rests: straight to the exact stop, then turning until it is supported."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import stiv
from stiv.blender.controls.rotations import rotation_matrix, rotation_vector
from stiv.blender.layout.layout_task import Stopped, Watch
from stiv.blender.layout.rigid_contacts import Contact, find_contacts, is_clear, travel
from stiv.blender.layout.rigid_scene import SURPLUS, RigidScene
from stiv.blender.scene.arrays import Floats
from stiv.task import Call, Steps

LONGEST_STEP, SHORTEST_STEP = 0.1, 2e-5  # of the body's size
PROGRESS = 1e-5  # of a step; a body that sinks by less is stopped
MAX_STEPS = 600
NUDGE = 0.02  # radians, to leave a balance on an edge or a corner
MAX_NUDGES = 4
MAX_LEVELLINGS = 12
MAX_ROWS, MAX_ITERATIONS = 64, 300  # of the contacts of a linear step
REACH = 3.0  # minimum distances within which contacts are levelled
SUPPORT = 1.0  # minimum distances within which a contact supports
LEVEL = 0.1  # the same for a body that rests already


@dataclass(frozen=True)
class Rest:
    """Where a body came to rest.

    Attributes:
        status: "rests", "nothing" (nothing below: it stays where it was), or "moving" (still sinking).
        contacts: where it is supported.
        distance: length of its way along the direction.
    """

    status: str
    contacts: tuple[Contact, ...] = ()
    distance: float = 0.0


def fall(scene: RigidScene, mover: int, direction: Floats, length: float = np.inf) -> Steps[float | None]:
    """Steps that translate a mover along a direction to its exact stop.

    They return the distance, None if nothing stops it. length: look no further than this.
    """
    corners, box = scene.extent(), scene.box(mover)
    far = float(np.abs(corners - box[::-1]).max(axis=0) @ np.abs(direction)) + scene.size(mover)
    far = min(far, length)
    fraction = yield from travel(scene, mover, far * direction)
    if fraction is None:
        return None
    distance = max(0.0, fraction * far - SURPLUS * scene.separation)
    if distance * 50 > scene.separation:  # nearer than the tolerance of `travel`, it rests already
        scene.shift(mover, distance * direction)
        return distance
    return 0.0


def rest(
    scene: RigidScene, mover: int, direction: Floats, watch: Watch, length: float = np.inf, *, turn: bool
) -> Steps[Rest]:
    """Steps that let a mover fall along a direction until it rests. Without support, its pose does not change.

    watch: stops them. length: of the way along the direction. turn: let it turn and slide until it is supported from
    below, if it can.
    """
    start = scene.pose(mover)
    if (yield from fall(scene, mover, direction, length)) is None:
        scene.set_pose(mover, start)
        return Rest("nothing")
    if turn and scene.movers[mover].can_turn and not is_supported(scene, mover, direction, LEVEL):
        if not (yield from _tumble(scene, mover, direction, watch, length)):
            scene.set_pose(mover, start)
            return Rest("nothing")
        for number in range(MAX_NUDGES):
            if is_supported(scene, mover, direction):
                break
            if not (yield from _leave_balance(scene, mover, direction, number, watch, length)):
                break
    distance = float((scene.pose(mover) - start)[0] @ direction)
    return Rest("rests", tuple(find_contacts(scene, mover, direction, SUPPORT)), distance)


def is_supported(scene: RigidScene, mover: int, direction: Floats, reach: float = SUPPORT) -> bool:
    """Is the center of a mover above the inside of the polygon of its contacts, seen along the direction?"""
    contacts = [each.point for each in find_contacts(scene, mover, direction, reach)]
    if len(contacts) < 3:
        return False
    across = _plane_across(direction)
    offsets = (np.array(contacts) - scene.pose(mover)[0]) @ across.T
    offsets = offsets[np.linalg.norm(offsets, axis=1) > 1e-9 * scene.size(mover)]
    angles = np.sort(np.arctan2(offsets[:, 1], offsets[:, 0]))
    if len(angles) < 3:
        return False
    gaps = np.diff(np.append(angles, angles[0] + 2 * np.pi))
    return bool(gaps.max() < np.pi - 1e-3)  # the center is inside if no half plane is empty


def _tumble(scene: RigidScene, mover: int, direction: Floats, watch: Watch, length: float) -> Steps[bool]:
    """Steps that let it sink, slide and turn, until the body sinks no further; False if it loses its support."""
    size = scene.size(mover)
    step, start = LONGEST_STEP * size, scene.pose(mover)
    session, home = None, start[0]
    for _ in range(MAX_STEPS):
        yield from watch.check()
        before = scene.pose(mover)
        if session is None or np.linalg.norm(before[0] - home) > size:
            session, home = (yield from scene.session(mover, _room(scene, mover, 2 * size))), before[0]
        goal = before.copy()
        goal[0] += step * direction
        result: stiv.EditResult = yield Call(session.edit, session.start_edit, goal)
        if result.status == "cancelled":
            raise Stopped("cancelled")
        scene.set_pose(mover, result.controls)
        if result.status == "reached" and (yield from fall(scene, mover, direction, length)) is None:
            return False
        if result.status == "reached":
            session = None
        if float((scene.pose(mover) - start)[0] @ direction) > length:
            return False
        sunk = float((scene.pose(mover) - before)[0] @ direction)
        if sunk < PROGRESS * step:
            scene.set_pose(mover, before)
            if step <= SHORTEST_STEP * size:
                break
            session = None
            step /= 4
    lifted = -REACH * scene.separation * direction  # the session may have come nearer than the minimum distance
    if (yield from travel(scene, mover, lifted)) is not None:
        scene.set_pose(mover, start)
        return True
    scene.shift(mover, lifted)
    yield from fall(scene, mover, direction, 3 * REACH * scene.separation)
    for _ in range(MAX_LEVELLINGS):
        if not (yield from _level(scene, mover, direction)):
            break
    return True


def _level(scene: RigidScene, mover: int, direction: Floats) -> Steps[bool]:
    """Steps that bring all contacts near the minimum distance to it, by one linear step; False if that sank nothing."""
    before, contacts = scene.pose(mover), find_contacts(scene, mover, direction, REACH)
    rows = {tuple(np.round(each.point / scene.separation).tolist()): each for each in contacts}
    chosen = list(rows.values())[:MAX_ROWS]
    arms = np.array([each.point for each in chosen]).reshape(-1, 3) - before[0]
    normals = np.array([each.normal for each in chosen]).reshape(-1, 3)
    radius = scene.size(mover) / 2 or 1.0  # any, for a single vertex
    jacobian = np.hstack([normals, np.cross(arms, normals) / radius])
    missing = np.array([each.separation - each.distance for each in chosen])
    step = least_step(jacobian, missing, REACH * scene.separation * np.append(direction, np.zeros(3)))
    pose = before.copy()
    pose[0] += step[:3]
    pose[1] = turned(pose[1], step[3:] / radius)
    scene.set_pose(mover, pose)
    lifted = -REACH * scene.separation * direction  # to be lowered to the exact stop
    scene.shift(mover, lifted)
    if is_clear(scene, mover):
        stop = yield from fall(scene, mover, direction, 3 * REACH * scene.separation)
        if stop is not None and float((scene.pose(mover) - before)[0] @ direction) > 1e-3 * scene.separation:
            return True
    scene.set_pose(mover, before)
    return False


def least_step(jacobian: Floats, bounds: Floats, wanted: Floats) -> Floats:
    """The step, (6,), nearest to a wanted one with jacobian @ step >= bounds, (k,) (projected Gauss-Seidel)."""
    forces, step = np.zeros(len(bounds)), wanted.copy()
    norms = np.einsum("kj,kj->k", jacobian, jacobian)
    for _ in range(MAX_ITERATIONS):
        largest = 0.0
        for k, row in enumerate(jacobian):
            force = max(0.0, forces[k] + (bounds[k] - float(row @ step)) / norms[k])
            step += (force - forces[k]) * row
            largest, forces[k] = max(largest, abs(force - forces[k])), force
        if largest < 1e-6 * float(np.linalg.norm(wanted)):
            break
    return step


def _leave_balance(
    scene: RigidScene, mover: int, direction: Floats, number: int, watch: Watch, length: float
) -> Steps[bool]:
    """Steps that turn a mover a little across the direction and let it sink again; False if it sank no further."""
    before = scene.pose(mover)
    angle = 0.6 + 0.5 * np.pi * number  # deterministic, along no axis of the world
    axis = np.array([np.cos(angle), np.sin(angle)]) @ _plane_across(direction)
    scene.shift(mover, -NUDGE * scene.size(mover) * direction)
    pose = scene.pose(mover)
    pose[1] = turned(pose[1], NUDGE * axis)
    scene.set_pose(mover, pose)
    if (
        is_clear(scene, mover)
        and (yield from fall(scene, mover, direction, length)) is not None
        and (yield from _tumble(scene, mover, direction, watch, length))
        and float((scene.pose(mover) - before)[0] @ direction) > scene.separation
    ):
        return True
    scene.set_pose(mover, before)
    return False


def turned(rotation: Floats, turn: Floats) -> Floats:
    """The rotation vector of `turn` after `rotation`, (3,) each."""
    return rotation_vector(rotation_matrix(turn) @ rotation_matrix(rotation))


def _room(scene: RigidScene, mover: int, margin: float) -> Floats:
    return scene.box(mover) + [[-margin], [margin]]


def _plane_across(direction: Floats) -> Floats:
    """Two unit vectors across a direction, (2, 3)."""
    first = np.cross(direction, np.eye(3)[np.abs(direction).argmin()])
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(direction, first)])
