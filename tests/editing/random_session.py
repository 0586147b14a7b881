# SPDX-License-Identifier: GPL-3.0-or-later
"""A ball among plates as a state machine: drags, undo, new obstacles, other separations and deformations.

After every step, the exact test finds no intersection, and an independent test shows that the path is clear.
"""

import itertools

import numpy as np
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

import stiv
from blend_fixtures.scenes.primitives import grid, icosphere

BALL = icosphere(1, 0.5)
PLATE = grid(2, 2, 1.2, 1.2)
MOST_PLATES = 5

PLACES = st.tuples(*[st.floats(-2, 2, width=32)] * 3)
SHIFTS = st.tuples(*[st.floats(-3, 3, width=32)] * 3)
TURNS = st.tuples(*[st.floats(-3, 3, width=32)] * 3)
SEPARATIONS = st.sampled_from([0.0, 1e-3, 0.02, 0.3])
MODES = st.sampled_from(["vertices", "rigid", "scaling"])
HAND_OVERS = st.sampled_from([None, 0.0])


class RandomSession(RuleBasedStateMachine):
    """The scene is `vertices` (ball first) and `plates`; the session edits it, `history` holds accepted controls."""

    done = 0  # steps of all sessions

    def __init__(self) -> None:
        super().__init__()
        self.vertices = BALL.vertices.astype(np.float32).astype(float)
        self.plates: list[np.ndarray] = []
        self.separation, self.mode = 0.0, "vertices"

    @initialize(mode=MODES)
    def begin(self, mode: str) -> None:
        self.mode = mode
        self.start()

    @rule(shift=SHIFTS, hand_over=HAND_OVERS)
    def drag(self, shift: tuple, hand_over: float | None) -> None:
        self.solve(lambda goal: self.session.drag(goal, hand_over=hand_over), shift, slice(None))

    @rule(shift=SHIFTS, first=st.integers(0, 40), hand_over=HAND_OVERS)
    @precondition(lambda self: self.mode == "vertices")
    def drag_some_vertices(self, shift: tuple, first: int, hand_over: float | None) -> None:
        self.solve(lambda goal: self.session.drag(goal, hand_over=hand_over), shift, slice(first, first + 12))

    @rule(shift=SHIFTS)
    def edit_in_one_call(self, shift: tuple) -> None:
        self.solve(lambda goal: self.session.edit(goal), shift, slice(None))

    @rule()
    def settle(self) -> None:
        self.take(self.session.settle())

    @rule(back=st.integers(1, 10))
    def undo(self, back: int) -> None:
        self.history = self.history[: max(1, len(self.history) - back)]
        self.session.restore(self.history[-1])
        np.testing.assert_array_equal(self.session.controls, self.history[-1])
        self.vertices = self.session.surface[: len(BALL.vertices)]

    @rule(place=PLACES, turn=TURNS)
    @precondition(lambda self: len(self.plates) < MOST_PLATES)
    def add_a_plate(self, place: tuple, turn: tuple) -> None:
        """Rejected without any change if the plate would intersect."""
        plate = PLATE.turned(turn).moved(place).vertices
        before = list(self.plates)
        self.plates.append(plate)
        try:
            self.start()
        except stiv.StartIntersectsError:
            assert len(stiv.find_intersections(self.positions(), self.surface())) > 0
            self.plates = before
            self.start()

    @rule(separation=SEPARATIONS)
    def separate(self, separation: float) -> None:
        self.separation = separation
        self.start()

    @rule(mode=MODES)
    def change_deformation(self, mode: str) -> None:
        self.mode = mode
        self.start()

    @invariant()
    def nothing_intersects(self) -> None:
        RandomSession.done += 1
        assert len(stiv.find_intersections(self.positions(), self.surface())) == 0

    def start(self) -> None:
        """A session from the current position of the ball."""
        ball = np.arange(len(BALL.vertices), dtype=np.int32)
        deformation, controls = self.deformation()
        whole = stiv.concatenate([(deformation, ball)], self.positions())
        options = stiv.EditOptions(separation=self.separation, single_precision=self.mode == "vertices")
        self.session = stiv.EditSession(self.surface(), whole, controls, options)
        self.whole, self.history = whole, [self.session.controls]
        self.steps = stiv.StepCheck(self.surface())

    def deformation(self) -> tuple[stiv.Deformation, np.ndarray]:
        if self.mode == "vertices":
            return stiv.identity(len(self.vertices)), self.vertices
        if self.mode == "rigid":
            return stiv.rigid(self.vertices), stiv.rigid_rest_controls(self.vertices)
        return stiv.scaling(self.vertices, np.eye(3)), stiv.scaling_rest_controls(self.vertices)

    def surface(self) -> stiv.Surface:
        faces = [BALL.triangles()]
        first = len(BALL.vertices)
        for _ in self.plates:
            faces.append(PLATE.triangles() + first)
            first += len(PLATE.vertices)
        bodies = [
            stiv.Body("Ball", "rigid" if self.mode == "rigid" else "deformable"),
            stiv.Body("Plates", "deformable"),
        ]
        owner = (np.arange(first) >= len(BALL.vertices)).astype(np.int32)
        return stiv.Surface(np.concatenate(faces), first, None, owner, bodies)

    def positions(self) -> np.ndarray:
        return np.concatenate([self.vertices, *self.plates])

    def solve(self, call, shift: tuple, rows: slice) -> None:
        goal = self.session.controls.copy()
        if self.mode == "vertices":
            goal[rows] += shift
        else:  # the centre, and a small rotation or scaling
            goal[0] += shift
            goal[1] *= 1 + 0.1 * shift[0]
        self.take(call(goal))

    def take(self, result: stiv.EditResult) -> None:
        states = [self.whole.surface(controls) for controls in (self.history[-1], *result.path)]
        for one, other in itertools.pairwise(states):
            assert np.array_equal(one, other) or self.steps.is_free(one, other)
        assert np.array_equal(states[-1], result.surface)
        self.vertices = result.surface[: len(BALL.vertices)]
        self.history.append(result.controls)
