"""What tests need beside Python: its absence fails in CI and skips on a user's machine."""

from __future__ import annotations

import os
import shutil
from typing import NoReturn

import pytest


def absent(name: str, package: str) -> NoReturn:
    without(f"{name} is not installed (Debian: apt-get install {package})")


def without(message: str) -> NoReturn:
    if os.environ.get("CI"):
        pytest.fail(message)
    pytest.skip(message)


def find_chromium() -> str:
    """Path of Chromium; without a window to draw it needs less than half of the time."""
    return installed("Chromium", "chromium-headless-shell", "chromium", "google-chrome")


def installed(name: str, *programs: str) -> str:
    """Path of a program by one of its names."""
    for program in programs:
        if path := shutil.which(program):
            return path
    absent(name, programs[0])
