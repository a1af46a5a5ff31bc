"""Sessions and passwords: how people sign in, are known, and sign out."""

from __future__ import annotations

import html
import re
import time

import pytest
from people import ADDRESS, PASSWORD, Somebody
from sqlalchemy import select, update
from starlette.testclient import TestClient

from quizgen.store.schema import SESSION
from quizgen.web.passwords import PasswordLimits

pytestmark = pytest.mark.both_databases


def cookie(somebody) -> str:
    return somebody.browser.cookies["quizgen"]


def test_a_session_leads_on_to_the_page_that_was_asked_for(manager, app):
    found = Somebody(app)
    asked = found.get("/progress")
    assert asked.url.path == "/sign-in"
    there = re.search(r'action="([^"]*)"', found.page.split("<main", 1)[1])[1]
    done = found.post(html.unescape(there), name="Farida", password=PASSWORD)
    assert done.url.path == "/progress"
    for elsewhere in ("//evil.example", "https://evil.example", "/\\evil.example"):
        found = Somebody(app)
        found.get(f"/sign-in?to={elsewhere}")
        sent = {"token": found.token, "name": "Farida", "password": PASSWORD}
        done = found.browser.post(f"/sign-in?to={elsewhere}", data=sent, follow_redirects=False)
        assert done.headers["location"] == "/"


def test_where_a_session_has_ended_one_signs_in_and_is_back(app, manager, learner):
    at = learner.post("/practice", template="point-to-image-plane").url.path
    learner.get("/")
    sent = {"token": learner.token, "a": ["1", "2"]}
    learner.browser.cookies.clear()
    for headers, status, said in (
        ({"accept": "text/html", "referer": ADDRESS + at}, 303, "location"),
        ({"hx-request": "true", "hx-current-url": f"{ADDRESS}{at}?said=1"}, 403, "hx-redirect"),
    ):
        answer = learner.browser.post(f"{at}/1", data=sent, headers=headers, follow_redirects=False)
        assert answer.status_code == status
        assert answer.headers[said] == "/sign-in?to=" + at.replace("/", "%2F") + "&ended=1"
    assert "Your session has ended" in learner.get(answer.headers[said]).text
    saved = learner.browser.post(at, data=sent, headers={"accept": "application/json"})
    assert saved.status_code == 403, "what the script keeps is not taken for kept"
    strange = {"accept": "text/html", "referer": "http://[evil//x"}
    assert learner.browser.post(at, data=sent, headers=strange).status_code == 200


def elsewhere(app, number: int = 77) -> Somebody:
    """A new browser at another address."""
    found = Somebody(app)
    found.browser = TestClient(app, ADDRESS, client=(f"192.168.1.{number}", 1))
    return found


@pytest.fixture
def now(site):
    """A clock that stands still until it is set."""
    now = [100.0]
    site.password_limits = PasswordLimits(lambda: now[0])
    return now


def test_wrong_passwords_have_to_wait_and_nobody_else_does(app, now, manager, learner):
    thief = Somebody(app)
    for _ in range(5):
        answer = thief.sign_in("Farida", "guess guess")
        assert answer.status_code == 403
        assert "do not belong together" in answer.text
    for _ in range(3):
        answer = thief.sign_in("FARIDA", PASSWORD)
        assert answer.status_code == 429, "not even the right one"
        now[0] += int(answer.headers["retry-after"])
        assert thief.sign_in("Farida", "guess guess").status_code == 403
    assert now[0] == 280, "one a minute"
    other = Somebody(app)
    assert other.sign_in("রহিম উদ্দিন").url.path == "/", "another name from the same address"
    assert elsewhere(app).sign_in("Farida").url.path == "/", "the same name from another address"
    now[0] += 60
    assert thief.sign_in("Farida").url.path == "/"


def test_an_unknown_name_takes_as_long_and_says_the_same(app, manager):
    found = Somebody(app)
    answers = {re.sub(r'value="[^"]*"', "", found.sign_in(name, "guess guess").text)
               for name in ("Farida", "Nobody")}  # fmt: skip
    assert len(answers) == 1


def test_signing_in_begins_a_session_of_its_own(app, site, manager):
    victim = Somebody(app)
    planted = "A" * 32
    victim.browser.cookies.set("quizgen", planted, domain="192.168.1.5")
    victim.sign_in("Farida")
    thief = TestClient(app, ADDRESS, cookies={"quizgen": planted})
    assert thief.get("/", follow_redirects=False).status_code == 303
    with site.store.database.reading() as connection:
        kept = set(connection.execute(select(SESSION.c.hash)).scalars())
    assert len(kept) == 2
    tokens = {one.value for one in victim.browser.cookies.jar} | {cookie(manager)}
    assert not tokens & kept, "only hashes are kept"
    assert "$argon2id$" in site.store.accounts.password_hash_of("Farida")[1]


def test_a_cookie_is_for_this_server_alone(app, manager, site):
    found = Somebody(app)
    found.get("/sign-in")
    sent = {"token": found.token, "name": "Farida", "password": PASSWORD}
    given = found.browser.post("/sign-in", data=sent, follow_redirects=False).headers["set-cookie"]
    assert {"httponly", "samesite=lax", "path=/"} <= {p.strip().lower() for p in given.split(";")}
    assert "secure" not in given.lower()
    safe = TestClient(app, "https://192.168.1.5")
    token = re.search(r'name="token" value="(\w+)"', safe.get("/sign-in").text)[1]
    answer = safe.post("/sign-in", data={**sent, "token": token}, follow_redirects=False)
    assert "secure" in answer.headers["set-cookie"].lower()


def test_signing_out_ends_the_session_and_no_other(app, site, manager):
    second = Somebody(app)
    second.sign_in("Farida")
    stolen = cookie(second)
    second.post("/sign-out")
    thief = TestClient(app, ADDRESS, cookies={"quizgen": stolen})
    assert thief.get("/", follow_redirects=False).status_code == 303
    assert manager.get("/").url.path == "/"


def test_a_form_belongs_to_its_session(manager, learner):
    manager.get("/")
    learner.get("/")
    assert manager.token != learner.token
    sent = {"token": learner.token, "lang": "bn", "back": "/"}
    assert manager.browser.post("/settings", data=sent).status_code == 403
    strange = {"token": manager.token, "lang": "bn", "back": "/"}
    wrong = {"sec-fetch-site": "cross-site"}
    assert manager.browser.post("/settings", data=strange, headers=wrong).status_code == 403
    assert manager.browser.post("/settings", data=strange).status_code == 200


def test_a_session_grows_old(app, site, manager):
    with site.store.database.writing() as connection:
        connection.execute(update(SESSION).values(until=time.time() - 1))
    assert manager.get("/").url.path == "/sign-in"


def test_a_new_password_signs_other_browsers_out(app, site, manager):
    second = Somebody(app)
    second.sign_in("Farida")
    manager.get("/account")
    new = {"password": "sechs blaue Birnen", "again": "sechs blaue Birnen"}
    assert manager.post("/account", old="wrong one", **new).status_code == 403
    done = manager.post("/account", old=PASSWORD, **new)
    assert "The password has been changed." in done.text
    assert second.get("/").url.path == "/sign-in"
    assert second.sign_in("Farida").status_code == 403
    assert second.sign_in("Farida", new["password"]).url.path == "/"


def test_pages_before_signing_in_speak_both_languages(app, site):
    stranger = Somebody(app)
    assert "Sign in" in stranger.get("/sign-in").text
    assert "সাইন ইন" in stranger.get("/sign-in?lang=bn").text
    assert (
        "সাইন ইন"
        in stranger.browser.get("/sign-in", headers={"accept-language": "de, bn;q=0.5"}).text
    )
    link = f"/invited?key={site.store.accounts.invite(manages=True)}&lang=bn"
    assert "স্বাগতম" in stranger.get(link).text
    key = re.search(r'<input type="hidden" name="key" value="([^"]*)"', stranger.page)[1]
    assert key in link, "the buttons of the languages keep it"
    stranger.join(link, "রিনা")
    assert "অনুশীলন" in stranger.get("/").text
