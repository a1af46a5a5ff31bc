"""What is meant to do harm is not kept for the user."""

from __future__ import annotations

import pytest


@pytest.fixture(autouse=True)
def _kept_apart(empty_cache):
    pass
