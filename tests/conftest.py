"""Shared fixtures."""

from __future__ import annotations

import difflib
import gc
import os
import sys
from collections.abc import Iterable
from concurrent.futures import Future
from itertools import islice
from pathlib import Path

import pytest
from needed import find_chromium, installed

from quizgen.bank.bank import Bank, builtin_bank
from quizgen.core import cache
from quizgen.core.executor import InlineExecutor

# Containers forbid bytecode to be kept; then every cold process that a test starts would compile
# SymPy and all the rest again, two seconds each.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False


SNAPSHOTS = Path(__file__).parent / "snapshots"
LINES_OF_A_DIFFERENCE = 60


def pytest_addoption(parser):
    parser.addoption(
        "--snapshot-update",
        action="store_true",
        help="write what is made now to tests/snapshots; the diff is then to be reviewed",
    )


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Mark what opens a browser, whether or not its author thought of it."""
    for item in items:
        if {"browser", "chromium", "firefox"} & {*getattr(item, "fixturenames", ())}:
            item.add_marker(pytest.mark.browser)


def pytest_collection_finish():
    """Look for no garbage among the thousands of tests, which stay to the end."""
    gc.collect()
    gc.freeze()


class Snapshots:
    """What users get, kept as text under ``tests/snapshots`` so that a change is read in a diff."""

    def __init__(self, *, update: bool) -> None:
        self._update = update

    def check(self, name: str, made: str) -> None:
        """Compare a text with the one kept under a name, or keep it with ``--snapshot-update``."""
        path = SNAPSHOTS / name
        if self._update:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(made, "utf-8")
        if not path.is_file():
            pytest.fail(f"there is no tests/snapshots/{name}: pytest --snapshot-update writes it")
        kept = path.read_text("utf-8")
        if made != kept:
            lines = difflib.unified_diff(
                kept.splitlines(), made.splitlines(), f"kept {name}", "made now", lineterm="", n=2
            )
            shown = "\n".join(islice(lines, LINES_OF_A_DIFFERENCE))
            pytest.fail(f"{shown}\nif this is meant: pytest --snapshot-update", pytrace=False)

    def check_names(self, folder: str, names: Iterable[str]) -> None:
        """Compare the files of a folder with those there should be; an update deletes the others."""
        wanted, found = {*names}, {path.name for path in (SNAPSHOTS / folder).iterdir()}
        if self._update:
            for name in found - wanted:
                (SNAPSHOTS / folder / name).unlink()
        else:
            assert found == wanted


@pytest.fixture(scope="session")
def snapshots(request) -> Snapshots:
    return Snapshots(update=request.config.getoption("--snapshot-update"))


@pytest.fixture(scope="session")
def bank() -> Bank:
    return builtin_bank()


@pytest.fixture
def jobs_in_this_process(monkeypatch):
    """Lets servers that begin now do their work here: processes of their own take seconds to begin."""
    from quizgen.web import job_cache

    class Here(InlineExecutor):
        def __init__(self, _count, prepare, given, **_more):
            self.processes, self._prepare = [], lambda: prepare(*given)

        def submit(self, fn, /, *args, **kwargs):
            self._prepare()  # another server may have prepared this process for its bank
            try:
                return super().submit(fn, *args, **kwargs)
            except Exception as error:  # noqa: BLE001
                failed = Future()
                failed.set_exception(error)
                return failed

        def start_all(self):
            """Needs none."""

        def stop(self):
            """Has none."""

    monkeypatch.setattr(job_cache, "ProcessExecutor", Here)


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
    return find_chromium()


@pytest.fixture(scope="session")
def firefox():
    return installed("Firefox", "firefox-esr", "firefox")


@pytest.fixture(scope="session")
def driver():
    """Playwright, of which a process can have one only."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as one:
        yield one


@pytest.fixture(scope="session")
def browser(chromium, driver):
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
