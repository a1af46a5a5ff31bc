"""What somebody sends who means no good, or twice, or all at once."""

from __future__ import annotations

import re
import socket
from concurrent.futures import ThreadPoolExecutor

import httpx2
import pytest

from quizgen.store import QuestionRef, Store
from quizgen.web.papers import unpack

EXAM_ROUTES = ("", "/flag/1", "/read/1", "/judge/1")
TURN_ROUTES = ("/again", "/variant", "/guided", "/next", "/1", "/1/read")


@pytest.fixture
def theirs(app):
    """A question and an exam of somebody else, both begun."""
    store = app.state.site.store
    other = store.learner("other").id
    attempt = store.start_attempt(other, QuestionRef("point-to-image-plane", "3"), {})
    sitting = store.sittings.begin(other, "trial-1-both-000000", None, pauses=False)
    return other, attempt, sitting


def test_what_belongs_to_others_is_not_there(client, token, theirs, app):
    other, attempt, sitting = theirs
    before = app.state.site.store.attempt(other, attempt.id)
    sent = {"token": token, "a": ["1", "2"], "on-1": "", "a-1": "5", "do": "hand-in"}
    assert client.get(f"/q/{attempt.id}").status_code == 404
    assert client.get(f"/exam/{sitting.id}").status_code == 404
    for route in TURN_ROUTES:
        assert client.post(f"/q/{attempt.id}{route}", data=sent).status_code == 404, route
    for route in EXAM_ROUTES:
        assert client.post(f"/exam/{sitting.id}{route}", data=sent).status_code == 404, route
    assert app.state.site.store.attempt(other, attempt.id) == before
    assert app.state.site.store.sittings.find(other, sitting.id) == sitting
    assert app.state.site.store.sittings.answers(sitting) == {}


def test_no_form_is_taken_without_its_token(client, app):
    posts = [
        re.sub(r"\{\w+\}", "1", route.path)
        for route in app.routes
        if "POST" in (getattr(route, "methods", None) or ())
    ]
    assert len(posts) > 10
    for address in posts:
        for sent in ({}, {"token": ""}, {"token": "ü"}, {"token": "0" * 64}):
            assert client.post(address, data=sent).status_code == 403, address


def test_a_body_without_a_length_is_measured(client):
    def much():
        for _ in range(100):
            yield b"a" * 100_000

    assert client.post("/settings", content=much()).status_code in {403, 413}  # not even read
    kind = {"content-type": "application/x-www-form-urlencoded"}
    assert client.post("/settings", content=much(), headers=kind).status_code == 413
    kind = {"content-type": "multipart/form-data; boundary=x"}
    assert client.post("/settings", content=much(), headers=kind).status_code in {400, 413}


@pytest.mark.parametrize(
    ("content", "kind"),
    [
        (b"token=%00", "application/x-www-form-urlencoded"),
        (b"&".join(b"a=1" for _ in range(1000)), "application/x-www-form-urlencoded"),
        (b"--x\r\nContent-Disposition: form-data\r\n\r\n1", "multipart/form-data; boundary=x"),
        (b"--x\r\n", "multipart/form-data"),
        (b'--x\r\nContent-Disposition: form-data; name="token"; filename="t"\r\n\r\n1\r\n--x--',
         "multipart/form-data; boundary=x"),
        (b'{"token": 1}', "application/json"),
        (b"\xff\xfe", "text/plain; charset=nonsense"),
    ],
)  # fmt: skip
def test_what_is_no_form_is_refused(client, content, kind):
    answer = client.post("/settings", content=content, headers={"content-type": kind})
    assert answer.status_code in {400, 403}


@pytest.mark.parametrize("typed", ["a\0b", "x" * 10_001])
def test_an_answer_that_is_no_text_is_refused(client, token, begin, typed):
    at = begin("point-to-image-plane")
    assert client.post(f"{at}/1", data={"token": token, "a": [typed, "1"]}).status_code == 400


@pytest.mark.parametrize(
    "address", ["/q/%00", "/exam/%00", "/static/%00", "/q/%ff", "/exam/%ed%a0"]
)
def test_addresses_that_are_no_text_are_not_there(client, address):
    assert client.get(address).status_code in {400, 404}


@pytest.mark.parametrize(
    "headers",
    [
        {"host": "evil.example", "x-forwarded-host": "127.0.0.1"}, {"content-length": "-1"},
        {"content-length": "1e3"}, {"content-length": "9" * 400}, {"host": "127.0.0.1@evil"},
    ],
)  # fmt: skip
def test_headers_do_not_talk_their_way_in(client, headers):
    assert client.get("/", headers=headers).status_code in {400, 413}


@pytest.mark.parametrize("cookie", ["quizgen=", "quizgen=x; quizgen=y", "=;=;", 'quizgen="\\377'])
def test_other_cookies_do_not_let_in(visitor, cookie):
    assert visitor.get("/", headers={"cookie": cookie}).status_code == 403


def test_what_is_typed_stays_text_everywhere(client, token, begin):
    typed = "\"'><img src=x onerror=alert(1)>{{ 'qz'*3 }}"
    at = begin("point-to-image-plane")
    page = client.post(f"{at}/1", data={"token": token, "a": [typed, "1"]}).text
    at = client.post("/exam", data={"token": token, "blueprint": "trial"}).url.path
    client.post(at, data={"token": token, "on-1a": "", "a-1a": typed})
    for text in (page, client.get(at).text,
                 client.post(at, data={"token": token, "do": "hand-in"}).text,
                 client.get(f"/exam?problem={typed}").text):  # fmt: skip
        assert "<img" not in text
        assert "qzqzqz" not in text


def _solution(part) -> set[str]:
    """What a learner may not see of a part, as the page would write it."""
    lines = [text for line in part.lines for text in (line.maths, line.why)]
    reasons = [text for _, text in part.reasons + part.mistakes]
    return {text for text in [*lines, *reasons, part.answer, part.why] if len(text) > 25}


def test_nothing_of_a_key_is_sent_before_it_is_handed_in(client, token, app):
    at = client.post("/exam", data={"token": token, "blueprint": "mock"}).url.path
    store = app.state.site.store
    sitting = store.sittings.find(store.learner().id, at.rsplit("/", 1)[1])
    kept = unpack(store.sittings.paper(sitting.paper), "en")
    parts = [part for item in kept.items for part in item.parts]
    json = {"accept": "application/json"}
    sent = [client.get(at).text, client.post(f"{at}/flag/1", data={"token": token}).text]
    for part in parts:
        name = part.field.id
        body = {"token": token, f"on-{name}": "", f"a-{name}": "1"}
        sent += [client.post(at, data=body, headers=json).text,
                 client.post(f"{at}/read/{name}", data=body).text]  # fmt: skip
    shown = "\n".join(sent)
    told = {text for part in parts for text in _solution(part)}
    offered = [text for p in parts for _, text in p.field.options + p.field.targets]
    public = "\n".join([*(item.stem for item in kept.items), *(p.body for p in parts), *offered])
    assert len(told) > 100
    assert [text for text in told if text in shown and text not in public] == []
    done = client.post(at, data={"token": token, "do": "hand-in"}).text
    assert sum(text in done for text in told) > len(told) / 2, "the test knows how pages write it"


@pytest.mark.parametrize(
    "sent",
    [
        {"blueprint": "all.9999"}, {"blueprint": "all", "minutes": "9999"},
        {"code": "all.9999-1-en-000000"}, {"blueprint": "all." + "9" * 5000},
    ],
)  # fmt: skip
def test_no_paper_of_days_is_made(client, token, app, monkeypatch, sent):
    asked = []
    monkeypatch.setattr(app.state.site.workers, "_submit", asked.append)
    answer = client.post("/exam", data={"token": token, **sent}, follow_redirects=False)
    assert answer.headers["location"].startswith("/exam?problem=")
    assert asked == []


@pytest.fixture
def outside(served):
    """A browser of a server in a process of its own, and the token of its forms."""
    with httpx2.Client(base_url=served.address, follow_redirects=True, timeout=60) as browser:
        page = browser.get(served.entrance).text
        yield browser, re.search(r'name="token" value="(\w+)"', page)[1]


def test_many_answers_at_once_count_once(outside, served):
    browser, token = outside
    asked = browser.post("/practice", data={"token": token, "template": "point-to-image-plane"})
    at = asked.url.path
    sent = {"token": token, "do": "solution", "a": ["", ""]}
    with ThreadPoolExecutor(8) as threads:
        answers = list(threads.map(lambda _: browser.post(f"{at}/1", data=sent), range(16)))
    assert {answer.status_code for answer in answers} == {200}
    store = Store(served.database)
    assert len(store.list_outcomes(store.learner().id)) == 1
    store.close()


def test_many_hands_hand_in_once(outside, served):
    browser, token = outside
    store = Store(served.database)
    before = len(store.list_outcomes(store.learner().id))
    page = browser.post("/exam", data={"token": token, "blueprint": "trial"})
    parts = set(re.findall(r'<fieldset data-part="(\w+)"', page.text))
    sent = {"token": token, "do": "hand-in"} | {f"on-{p}": "" for p in parts}
    sent |= {f"a-{p}": "1" for p in parts}
    with ThreadPoolExecutor(8) as threads:
        answers = list(threads.map(lambda _: browser.post(page.url.path, data=sent), range(16)))
    assert {answer.status_code for answer in answers} == {200}
    learner = store.learner().id
    after = len(store.list_outcomes(learner)) - before
    sitting = store.sittings.latest(learner, 1)[0]
    assert store.sittings.answers(sitting).keys() == parts
    store.close()
    assert 0 < after <= len(parts)


def test_who_reads_or_writes_slowly_holds_up_nobody(outside, served):
    browser, _ = outside
    slow = [socket.create_connection(("127.0.0.1", served.port)) for _ in range(50)]
    for place, one in enumerate(slow):
        one.sendall(b"POST /settings HTTP/1.1\r\nHost: 127.0.0.1\r\n"[: 20 + place])
    try:
        assert browser.get("/").status_code == 200
    finally:
        for one in slow:
            one.close()
