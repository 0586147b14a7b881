# SPDX-License-Identifier: GPL-3.0-or-later
"""Converged solutions of another method: an interior-point solver with ipctk's barrier and continuous
detection.

It minimises, over the controls p that may respond,

    1/2 |f(p) - f(goal)|^2 + kappa sum b(d(f(p)), dhat)

with the normalised clamped log barrier [Li et al. 2020, 2023], by projected Newton steps that end before the
first contact. dhat decreases down to our separation; then kappa is halved until the energy stops decreasing.
The method has no minimum distance except that of the barrier, and no damping, so it can end closer to the
goal than ours. It supports deformations that are linear in their controls, and one rigid body. Needs ipctk and SciPy.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import stiv
from blend_fixtures.scenes.families import Edit

Array = NDArray[np.float64]
LEVELS = (1e-2, 3e-3, 1e-3, 3e-4)  #: of dhat, in diagonals, before the separation itself
LONGEST_STEP = 0.05  #: of a vertex in one Newton step, in diagonals
TOLERANCE = 1e-5  #: slope along the step over the energy
DENSE_SHARE = 0.1  #: of entries that are not zero, from which on the Newton matrix is dense


@dataclass(frozen=True)
class Optimum:
    """Result of the solver."""

    energy: float
    controls: Array
    steps: int
    seconds: float  #: of the processor
    converged: bool  #: within the time limit


class LinearMotion:
    """f(p) = M p + c: a step moves all vertices along straight lines."""

    is_straight = True

    def __init__(self, edit: Edit) -> None:
        self._free = responding(edit)
        matrix = jacobian(edit)[:, self._free]
        self._expand = scipy.sparse.kron(matrix, scipy.sparse.identity(3), format="csr")  # (3n, 3m)
        self._own = self._expand.T @ self._expand
        self.free_count = len(self._free)
        self.moves = np.asarray(abs(matrix).sum(axis=1)).ravel() > 0

    def derivatives(self, _p: Array, _surface: Array) -> tuple[Any, Any]:
        """Derivatives J (3n, 3m') of the surface by the step, and J^T J."""
        return self._expand, self._own

    def along(self, p: Array, direction: Array, step: float) -> Array:
        """Controls after a fraction of a step (m', 3)."""
        q = p.copy()
        q[self._free] += step * direction
        return q


class RigidMotion:
    """Controls are a center and a rotation vector; a step adds to the center and to the rotation."""

    is_straight = False
    free_count = 2

    def __init__(self, edit: Edit) -> None:
        moved = edit.deformation.surface(edit.controls + [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
        self.moves = np.any(moved != edit.deformation.surface(edit.controls), axis=1)

    def derivatives(self, p: Array, surface: Array) -> tuple[Any, Any]:
        """Derivatives J (3n, 6) of the surface by the step, and J^T J."""
        arm = np.where(self.moves[:, None], surface - p[0], 0)
        whole = np.zeros((len(surface), 3, 6))
        whole[self.moves, :, :3] = np.eye(3)
        for axis in range(3):
            whole[:, :, 3 + axis] = np.cross(np.eye(3)[axis], arm)
        expand = scipy.sparse.csr_matrix(whole.reshape(-1, 6))
        return expand, expand.T @ expand

    def along(self, p: Array, direction: Array, step: float) -> Array:
        """Controls after a fraction of a step (2, 3)."""
        turned = Rotation.from_rotvec(step * direction[1]) * Rotation.from_rotvec(p[1])
        return np.array([p[0] + step * direction[0], turned.as_rotvec()])


def responding(edit: Edit) -> NDArray[np.int64]:
    """Controls with weight that move a vertex."""
    weights = np.asarray(edit.options.get("weights", np.ones(len(edit.controls))), float)
    used = np.asarray(abs(jacobian(edit)).sum(axis=0)).ravel() > 0
    return np.flatnonzero((weights > 0) & used)


def jacobian(edit: Edit) -> Any:
    """The sparse matrix M (n, m) of f(p) = M p + c, by differences; exact up to rounding."""
    rest = edit.deformation.surface(edit.controls)
    columns = []
    for control in range(len(edit.controls)):
        moved = edit.controls.copy()
        moved[control, 0] += 1
        column = edit.deformation.surface(moved)[:, 0] - rest[:, 0]
        columns.append(scipy.sparse.csc_matrix(np.where(abs(column) > 1e-12, column, 0)[:, None]))
    return scipy.sparse.hstack(columns, format="csr")


class InteriorPoint:
    """One edit."""

    def __init__(self, ipctk: ModuleType, edit: Edit, separation: float, seconds: float) -> None:
        ipctk.set_num_threads(1)
        ipctk.set_logger_level(ipctk.off)
        self._ipctk, self._edit, self._separation = ipctk, edit, separation
        self._motion = RigidMotion(edit) if len(edit.controls) == 2 else LinearMotion(edit)
        self._goal = edit.deformation.surface(edit.goal)
        start = edit.deformation.surface(edit.controls)
        self._diagonal = float(np.linalg.norm(np.ptp(start, axis=0)))
        triangles = np.asfortranarray(edit.surface.triangles)
        self._mesh = ipctk.CollisionMesh(np.asfortranarray(start), ipctk.edges(triangles), triangles)
        moves = self._motion.moves
        patches = np.where(moves, np.arange(len(moves)) + 1, 0).astype(np.int32)
        self._mesh.can_collide = ipctk.make_vertex_patches_filter(patches)
        self._broad, self._narrow = ipctk.LBVH(), ipctk.AdditiveCCD()
        self._until = time.process_time() + seconds
        self._steps, self._moves = 0, int(moves.sum())

    def solve(self, controls: Array) -> Optimum:
        """Solve from intersection-free controls (m, 3)."""
        began = time.process_time()
        p = controls.copy()
        levels = [level * self._diagonal for level in LEVELS if level * self._diagonal > 1.5 * self._separation]
        for dhat in levels:
            p = self._minimise(p, dhat, self._stiffness(p, dhat), 100 * TOLERANCE, 60)
        stiffness = self._stiffness(p, self._separation)
        p = self._minimise(p, self._separation, stiffness, TOLERANCE, 400)
        energy = self._energy(self._surface(p))
        for _ in range(14):
            stiffness /= 2
            q = self._minimise(p, self._separation, stiffness, TOLERANCE, 200)
            gain = energy - self._energy(self._surface(q))
            if gain > 0:
                p, energy = q, energy - gain
            if gain < 1e-4 * energy or self._late():
                break
        return Optimum(energy, p, self._steps, time.process_time() - began, not self._late())

    def _late(self) -> bool:
        return time.process_time() > self._until

    def _surface(self, p: Array) -> Array:
        return np.asfortranarray(self._edit.deformation.surface(p))

    def _energy(self, surface: Array) -> float:
        return 0.5 * float(((surface - self._goal) ** 2).sum())

    def _stiffness(self, p: Array, dhat: float) -> float:
        force = np.sqrt(2 * self._energy(self._surface(p)) / self._moves)
        return float(force * dhat * max(self._moves / self._motion.free_count / 10, 1.0))

    def _contacts(self, surface: Array, dhat: float) -> Any:
        contacts = self._ipctk.NormalCollisions()
        contacts.build(self._mesh, surface, dhat, 0.0, self._broad)
        return contacts

    def _minimise(self, p: Array, dhat: float, stiffness: float, tolerance: float, most: int) -> Array:
        potential = self._ipctk.BarrierPotential(self._ipctk.NormalizedClampedLogBarrier(), dhat, stiffness)
        surface = self._surface(p)
        contacts = self._contacts(surface, dhat)
        value = self._energy(surface) + potential(contacts, self._mesh, surface)
        for _ in range(most):
            if self._late():
                return p
            self._steps += 1
            direction, slope = self._direction(p, potential, contacts, surface)
            if slope < tolerance * self._energy(surface) or slope <= 0:
                return p
            step = self._longest_step(p, direction, surface)
            while step > 1e-12:
                q = self._motion.along(p, direction, step)
                ahead = self._surface(q)
                near = self._contacts(ahead, dhat)
                new = self._energy(ahead) + potential(near, self._mesh, ahead)
                is_free = self._motion.is_straight or self._free_fraction(surface, ahead) == 1
                if new <= value - 1e-4 * step * slope and is_free:
                    break
                step /= 2
            else:
                return p
            p, surface, contacts, value = q, ahead, near, new
        return p

    def _direction(self, p: Array, potential: Any, contacts: Any, surface: Array) -> tuple[Array, float]:
        """The Newton step (m', 3), and the slope of the objective along it."""
        gradient = potential.gradient(contacts, self._mesh, surface) + (surface - self._goal).reshape(-1)
        hessian = potential.hessian(contacts, self._mesh, surface, self._ipctk.PSDProjectionMethod.CLAMP)
        expand, own = self._motion.derivatives(p, surface)
        pulled = expand.T @ gradient
        matrix = own + expand.T @ (hessian @ expand)
        damping = 1e-9 * matrix.diagonal().mean()
        if own.nnz > DENSE_SHARE * len(pulled) ** 2:
            whole = matrix.toarray() + damping * np.eye(len(pulled))
            direction = -scipy.linalg.cho_solve(scipy.linalg.cho_factor(whole, check_finite=False), pulled)
        else:
            whole = scipy.sparse.csc_matrix(matrix + damping * scipy.sparse.identity(len(pulled)))
            options = {"SymmetricMode": True}
            factor = scipy.sparse.linalg.splu(whole, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
            direction = -factor.solve(pulled)
        return direction.reshape(-1, 3), -float(pulled @ direction)

    def _longest_step(self, p: Array, direction: Array, surface: Array) -> float:
        """The largest step up to 1, the longest motion, and the first contact."""
        whole = self._surface(self._motion.along(p, direction, 1.0))
        reach = np.linalg.norm(whole - surface, axis=1).max()
        step = min(1.0, LONGEST_STEP * self._diagonal / max(reach, 1e-300))
        while True:  # a shorter turn has another chord
            ahead = self._surface(self._motion.along(p, direction, step))
            free = self._free_fraction(surface, ahead)
            if free == 1 or self._motion.is_straight:
                return step * free
            step *= 0.98 * free

    def _free_fraction(self, start: Array, end: Array) -> float:
        free: float = self._ipctk.compute_collision_free_stepsize(
            self._mesh, start, end, 0.0, self._broad, self._narrow
        )
        return free


def separation_of(edit: Edit) -> float:
    """The separation of a session in an edit's scene."""
    options = stiv.EditOptions(**edit.options)  # type: ignore[arg-type]
    return stiv.EditSession(edit.surface, edit.deformation, edit.controls, options).separation
