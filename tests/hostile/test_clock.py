"""The clock of an exam follows no clock that is set: an hour back gives nobody an hour."""

from __future__ import annotations

import logging

import pytest

from quizgen.store.clock import Clock


class Hands:
    """A clock that can be set, and one that cannot."""

    def __init__(self) -> None:
        self.wall, self.even = 1e9, 50.0
        self.clock = Clock(None, lambda: self.wall, lambda: self.even)

    def wait(self, seconds: float) -> None:
        self.wall += seconds
        self.even += seconds


@pytest.mark.parametrize("jump", [-3600.0, 3 * 3600.0])
def test_a_clock_that_is_set_gives_and_takes_no_time(jump, caplog):
    hands = Hands()
    with caplog.at_level(logging.WARNING):
        hands.wait(60)
        hands.wall += jump
        assert hands.clock.now() == 1e9 + 60
        hands.wait(60)
        assert hands.clock.now() == 1e9 + 120
    (told,) = caplog.messages
    assert f"{jump:+.1f} s" in told
