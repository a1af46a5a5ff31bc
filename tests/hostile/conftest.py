"""What is meant to do harm is not kept for the user."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "web"))  # its servers and databases


@pytest.fixture(autouse=True)
def _kept_apart(empty_cache):
    pass
