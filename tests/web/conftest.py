"""A server in the same process, for one learner; and one of its own for browsers."""

from __future__ import annotations

import re

import pytest
from own_bank import own_bank
from served import Served
from sqlalchemy import delete
from starlette.testclient import TestClient

from quizgen.bank.bank import builtin_bank
from quizgen.core.executor import ProcessExecutor
from quizgen.store import QuestionRef
from quizgen.store.schema import LEARNER
from quizgen.web import job_cache
from quizgen.web.app import create_app
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.settings import ServerSettings

ADDRESS = "http://127.0.0.1:8000"


def pytest_generate_tests(metafunc):
    if "database" in metafunc.fixturenames:
        marked = metafunc.definition.get_closest_marker
        second = [pytest.param("postgresql", marks=pytest.mark.slow)]
        both = second if marked("both_databases") else []
        metafunc.parametrize("database", ["sqlite", *both], indirect=True, scope="module")


@pytest.fixture(scope="session")
def cluster():
    """A PostgreSQL server, where something asks for one."""
    from databases import Cluster

    begun = Cluster()
    yield begun
    begun.end()


@pytest.fixture(scope="module")
def database(request, tmp_path_factory):
    """Makes databases, each new and empty; their addresses."""
    if request.param == "postgresql":
        return request.getfixturevalue("cluster").database

    def made() -> str:
        return f"sqlite:///{tmp_path_factory.mktemp('data') / 'learning.sqlite3'}"

    return made


@pytest.fixture(scope="module")
def settings(database):
    return ServerSettings(database(), workers=1)


class SharedProcess(ProcessExecutor):
    """The worker process that the servers of many modules share: each takes seconds to begin."""

    def start_all(self) -> None:
        if not self.processes:
            super().start_all()

    def stop(self) -> None:
        """Ends no process, which the next server needs."""


@pytest.fixture(scope="session")
def shared_process():
    """The one process of all servers of the built-in bank in this worker of pytest."""
    bank = builtin_bank()
    begun = SharedProcess(1, job_cache.prepare_process, (bank,), longest=job_cache.LONGEST)
    yield begun
    ProcessExecutor.stop(begun)


@pytest.fixture(scope="module")
def app(settings, shared_process):
    """The application, running."""
    with pytest.MonkeyPatch.context() as patch:
        if (settings.workers, settings.bank) == (1, builtin_bank()):
            patch.setattr(job_cache, "ProcessExecutor", lambda *_, **__: shared_process)
        app = create_app(settings)
    with TestClient(app, ADDRESS):
        yield app


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    """The folder of a bank of one template."""
    root = tmp_path_factory.mktemp("bank")
    own_bank(root)
    return root


@pytest.fixture
def nothing_done(app):
    """Somebody who has done nothing yet."""
    store = app.state.site.store
    with store.database.writing() as connection:
        connection.execute(delete(LEARNER))
    store.learner()


@pytest.fixture
def visitor(app):
    """A browser that has not been let in."""
    return TestClient(app, ADDRESS)


@pytest.fixture
def client(visitor, app):
    """A browser that was let in."""
    visitor.get(f"/enter?key={app.state.site.settings.token}")
    return visitor


@pytest.fixture
def token(client):
    return csrf_token(client.cookies[COOKIE])


@pytest.fixture
def begin(app):
    """Begins a certain question; its address."""

    def begun(template: str, seed: str = "3") -> str:
        store = app.state.site.store
        return f"/q/{store.start_attempt(store.learner().id, QuestionRef(template, seed), {}).id}"

    return begun


@pytest.fixture
def sections():
    """The parts of a page, as a reader sees their text."""

    def texts(page: str) -> list[str]:
        parts = re.findall(r'<section class="part".*?</section>', page, re.DOTALL)
        return [" ".join(re.sub(r"<[^>]*>", " ", part).split()) for part in parts]

    return texts


@pytest.fixture(scope="module")
def served(database):
    """A server in a process of its own."""
    server = Served(database(), "--workers", "1")  # each takes seconds to begin
    yield server
    server.kill()


@pytest.fixture
def opened(browser, served):
    """Opens a page of the server that was let in; nothing may be wrong on it."""
    from playwright.sync_api import expect

    expect.set_options(timeout=20_000)
    contexts, wrong = [], []

    def said(message) -> None:
        if message.type in {"error", "warning"}:
            wrong.append(message.text)

    def asked(request) -> None:
        if not request.url.startswith((served.address, "data:")):
            wrong.append(request.url)

    def one(**how):
        context = browser.new_context(**{"viewport": {"width": 1000, "height": 900}, **how})
        context.set_default_timeout(20_000)
        contexts.append(context)
        context.on("console", said)
        context.on("weberror", lambda error: wrong.append(str(error.error)))
        context.on("request", asked)
        page = context.new_page()
        page.goto(served.entrance)
        return page

    one.wrong = wrong
    yield one
    for context in contexts:
        context.close()
    assert wrong == []
