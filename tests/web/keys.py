"""Somebody who has no mouse."""

from __future__ import annotations

import pytest

MOST = 400
"""Presses of Tab after which there is no way."""


class Keys:
    """The keyboard of a page."""

    def __init__(self, page) -> None:
        self.page = page

    def to(self, name: str) -> None:
        """Go on by Tab to what is called like that."""
        self._until("name => document.activeElement.textContent.trim() === name", name)

    def on(self, locator) -> None:
        """Go on by Tab to an element."""
        self._until("element => document.activeElement === element", locator.element_handle())

    def _until(self, reached: str, what: object) -> None:
        self.page.wait_for_load_state()  # then the scripts listen, and move the focus no more
        for _ in range(MOST):
            self.page.keyboard.press("Tab")
            if self.page.evaluate(reached, what):
                return
        pytest.fail(f"no way by Tab to {what}")
