# SPDX-License-Identifier: GPL-3.0-or-later
"""A thousand random steps of editing sessions, each checked; tests/long/random_sessions.py does twenty thousand."""

from hypothesis import HealthCheck, settings
from hypothesis.stateful import run_state_machine_as_test
from random_session import RandomSession

from tests.examples import examples

QUIET = settings(
    max_examples=examples(60),
    stateful_step_count=50,
    deadline=None,
    derandomize=True,
    suppress_health_check=list(HealthCheck),
)


def test_a_thousand_random_steps_never_make_an_intersection():
    RandomSession.done = 0
    run_state_machine_as_test(RandomSession, settings=QUIET)
    assert RandomSession.done >= examples(1000)
