"""The same code begun twice: one sitting, and none of its key before it is handed in."""

from __future__ import annotations

import re

import pytest
from starlette.testclient import TestClient

from quizgen.locale import BOTH
from quizgen.paper.blueprint import find_blueprint
from quizgen.paper.paper import build_paper
from quizgen.web.app import create_app
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.settings import ServerSettings


@pytest.fixture
def app(tmp_path, jobs_in_this_process):
    app = create_app(ServerSettings(f"sqlite:///{tmp_path / 'learning.sqlite3'}", workers=1))
    with TestClient(app, "http://127.0.0.1:8000"):
        yield app


@pytest.fixture
def client(app):
    """A browser that was let in."""
    browser = TestClient(app, "http://127.0.0.1:8000")
    browser.get(f"/enter?key={app.state.site.settings.token}")
    return browser


@pytest.fixture
def token(client):
    return csrf_token(client.cookies[COOKIE])


@pytest.fixture(scope="module")
def code(bank):
    """A paper that is the same on every day."""
    return build_paper(bank, find_blueprint("trial", bank), 7, BOTH, figures=False).code


@pytest.fixture
def exam(client, token, code):
    """Begins the exam of the code: its address and page."""

    def begin(**how: str):
        page = client.post("/exam", data={"token": token, "code": code, "clock": "1", **how})
        assert page.status_code == 200, page.text
        return page.url.path, page.text

    return begin


def test_a_code_begun_is_one_exam_until_it_is_handed_in(client, token, exam, code):
    at, _ = exam()
    again, _ = exam()
    assert again == at
    single = code.replace("-both-", "-en-")
    assert client.post("/exam", data={"token": token, "code": single}).url.path == at


def test_a_paper_whose_key_was_shown_is_begun_again_for_practice_alone(client, token, exam, app):
    at, page = exam()
    assert "whoever has this code has the solutions" in page
    client.post(at, data={"token": token, "do": "hand-in"})
    refused, told = exam()
    assert refused == "/exam"
    assert "You have seen the key of this paper" in told
    again, practised = exam(practice="1")
    assert again != at
    assert exam(practice="1")[0] == again
    stem = re.findall(r'<div class="stem">.*?</div>', page, re.DOTALL)
    assert re.findall(r'<div class="stem">.*?</div>', practised, re.DOTALL) == stem
    store = app.state.site.store
    assert store.sittings.find(store.learner().id, again.rsplit("/", 1)[1]).practice
