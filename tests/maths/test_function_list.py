"""The page of functions says what the table has."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))

from list_functions import build_page  # noqa: E402 - tools are no package


def test_the_page_of_functions_is_made_from_the_table():
    assert (ROOT / "docs" / "functions.md").read_text("utf-8") == build_page()
