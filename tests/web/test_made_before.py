"""What is made before it is asked, and how much of what was made is kept."""

from __future__ import annotations

import pytest
from starlette.testclient import TestClient

from quizgen.core.errors import BankError
from quizgen.web.app import create_app
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.job_cache import ResultCache
from quizgen.web.question_view import QuestionRequest
from quizgen.web.settings import ServerSettings

QUESTION = "point-to-image-plane"


@pytest.fixture(scope="module")
def client(tmp_path_factory):
    """A browser that was let in, at a server with two processes that make questions."""
    file = tmp_path_factory.mktemp("data") / "x.sqlite3"
    app = create_app(ServerSettings(f"sqlite:///{file}", workers=2))
    with TestClient(app, "http://127.0.0.1:8000") as browser:
        browser.get(f"/enter?key={app.state.site.settings.token}")
        yield browser


@pytest.fixture
def site(client):
    return client.app.state.site


@pytest.fixture
def asked(site, monkeypatch):
    """What the processes are asked, in turn."""
    found, ask = [], site.workers._submit
    monkeypatch.setattr(site.workers, "_submit", lambda one: found.append(one) or ask(one))
    return found


@pytest.fixture
def token(client):
    return {"token": csrf_token(client.cookies[COOKIE])}


def posted(client, at: str, **fields: str) -> str:
    """Where a form leads."""
    return client.post(at, data=fields, follow_redirects=False).headers["location"]


def which(site, at: str) -> tuple[str, str]:
    """Template and seed of a question."""
    attempt = site.store.attempt(site.store.learner().id, at.rsplit("/", 1)[1])
    return attempt.template, attempt.seed


@pytest.mark.parametrize("action", ["next", "variant"])
def test_what_is_asked_after_a_question_was_made_while_it_was_shown(
    client, site, asked, token, action
):
    at = posted(client, "/practice", **token, template=QUESTION)
    client.get(at)
    made = [(one.template, one.seed) for one in asked]
    following = posted(client, f"{at}/{action}", **token)
    assert which(site, following) == made[{"next": 1, "variant": 2}[action]]
    client.get(following)
    assert asked.count(QuestionRequest(*which(site, following), "en")) == 1


def test_the_same_wish_twice_gives_other_numbers(client, site, token):
    at = posted(client, "/practice", **token, template=QUESTION)
    found = {which(site, posted(client, f"{at}/variant", **token)) for _ in range(3)}
    assert len(found | {which(site, at)}) == 4


def test_nothing_is_made_ahead_where_that_would_take_the_last_process(
    client, site, asked, token, monkeypatch
):
    at = posted(client, "/practice", **token, template=QUESTION)
    monkeypatch.setitem(site.workers._due, QuestionRequest("another", "1", "en"), None)
    client.get(at)
    assert [(one.template, one.seed) for one in asked] == [which(site, at)]


def test_what_cannot_be_made_ahead_is_said_to_who_asks(client, site):
    nothing = QuestionRequest("nothing", "1", "en")
    client.portal.call(site.workers.prefetch, nothing)
    with pytest.raises(BankError):
        client.portal.call(site.workers.get_question, nothing)


def keys(kept: ResultCache) -> list[str]:
    return [one for one in "abcd" if kept.get(one) is not None]


def test_the_latest_are_kept_as_far_as_there_is_room():
    kept = ResultCache(10)
    kept.store_result("a", b"1", 4)
    kept.store_result("b", b"2", 4)
    assert keys(kept) == ["a", "b"]
    kept.get("a")
    kept.store_result("c", b"3", 4)
    assert keys(kept) == ["a", "c"], "b was not asked for the longest"
    kept.store_result("c", b"4", 6)
    assert keys(kept) == ["a", "c"], "in place of the other one"
    kept.store_result("d", b"5", 11)
    assert keys(kept) == []
    kept.store_result("a", b"6", 10)
    assert keys(kept) == ["a"]
