"""A server in the same process, for one learner."""

from __future__ import annotations

import re

import pytest
from starlette.testclient import TestClient

from quizgen.web.app import application
from quizgen.web.guard import form_token
from quizgen.web.settings import Settings
from quizgen.web.store import Which

ADDRESS = "http://127.0.0.1:8000"


@pytest.fixture(scope="module")
def settings(tmp_path_factory):
    file = tmp_path_factory.mktemp("data") / "learning.sqlite3"
    return Settings(f"sqlite:///{file}", workers=1)


@pytest.fixture(scope="module")
def app(settings):
    """The application, running."""
    app = application(settings)
    with TestClient(app, ADDRESS):
        yield app


@pytest.fixture
def visitor(app):
    """A browser that has not been let in."""
    return TestClient(app, ADDRESS)


@pytest.fixture
def client(visitor, settings):
    """A browser that was let in."""
    visitor.get(f"/enter?key={settings.token}")
    return visitor


@pytest.fixture
def token(settings):
    return form_token(settings.token)


@pytest.fixture
def begin(app):
    """Begins a certain question; its address."""

    def begun(template: str, seed: str = "3") -> str:
        store = app.state.site.store
        return f"/q/{store.begin(store.learner().id, Which(template, seed), {}).id}"

    return begun


@pytest.fixture
def sections():
    """The parts of a page, as a reader sees their text."""

    def texts(page: str) -> list[str]:
        parts = re.findall(r'<section class="part".*?</section>', page, re.DOTALL)
        return [" ".join(re.sub(r"<[^>]*>", " ", part).split()) for part in parts]

    return texts
