"""Shared fixtures."""

from __future__ import annotations

import os
import shutil

import pytest

from quizgen.bank.folder import Bank, builtin


@pytest.fixture(scope="session")
def bank() -> Bank:
    return builtin()


@pytest.fixture(scope="session")
def chromium():
    """Path of Chromium; its absence fails in CI and skips on a user's machine."""
    path = shutil.which("chromium") or shutil.which("google-chrome")
    if path is None:
        message = "Chromium is not installed (Debian: apt-get install chromium)"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)
    return path


@pytest.fixture(scope="session")
def browser(chromium):
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        instance = driver.chromium.launch(
            executable_path=chromium, args=["--no-sandbox", "--disable-background-networking"]
        )
        yield instance
        instance.close()
