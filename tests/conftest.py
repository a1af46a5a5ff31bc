"""Shared fixtures."""

from __future__ import annotations

import os
import sys

import pytest
from needed import installed

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.core import cache

# Containers forbid bytecode to be kept; then every cold process that a test starts would compile
# SymPy and all the rest again, two seconds each.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False


@pytest.fixture(scope="session")
def bank() -> Bank:
    return builtin_bank()


@pytest.fixture
def empty_cache(tmp_path, monkeypatch):
    """The folder of a cache of one's own, of which a process has not yet heard."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(cache, "SHIPPED", tmp_path / "shipped")
    heard_of = cache.user_cache_folder, cache.remove_stale
    for one in heard_of:
        one.cache_clear()
    yield tmp_path / "cache" / "quizgen"
    monkeypatch.undo()
    for one in heard_of:
        one.cache_clear()


@pytest.fixture(scope="session")
def chromium():
    return installed("Chromium", "chromium", "google-chrome")


@pytest.fixture(scope="session")
def firefox():
    return installed("Firefox", "firefox-esr", "firefox")


@pytest.fixture(scope="session")
def browser(chromium):
    from playwright.sync_api import sync_playwright

    with sync_playwright() as driver:
        instance = driver.chromium.launch(
            executable_path=chromium, args=["--no-sandbox", "--disable-background-networking"]
        )
        yield instance
        instance.close()


@pytest.fixture
def barriers():
    """What keeps people out of a page: what axe finds, and scrolling sideways."""
    from axe_playwright_python.sync_playwright import Axe

    def found(page) -> list[tuple[str, str]]:
        told = Axe().run(page, options={"resultTypes": ["violations"]}).response["violations"]
        wide = page.evaluate("document.documentElement.scrollWidth > innerWidth")
        return [(one["id"], one["nodes"][0]["html"][:200]) for one in told] + [("wide", "")] * wide

    return found


@pytest.fixture
def collection(tmp_path):
    """An Anki collection to import into."""
    from anki.collection import Collection

    opened = Collection(str(tmp_path / "collection.anki2"))
    yield opened
    opened.close()
