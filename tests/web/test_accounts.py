"""People who sign in: invited, known by a session, each with what is theirs."""

from __future__ import annotations

import html
import re
import time
from concurrent.futures import ThreadPoolExecutor

import argon2
import pytest
from people import ADDRESS, PASSWORD, Somebody
from sqlalchemy import delete, func, select, update
from sqlalchemy.exc import OperationalError
from starlette.testclient import TestClient

from quizgen.web import accounts, passwords
from quizgen.web.passwords import Patience
from quizgen.web.settings import Settings
from quizgen.web.store.tables import ACCOUNT, ANSWER, ATTEMPT, INVITATION, LEARNER, SESSION

pytestmark = pytest.mark.both_databases


@pytest.fixture(scope="module")
def settings(database):
    return Settings(database(), host="0.0.0.0", workers=1)


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """Passwords that take no time; how long they take is Argon2's own matter."""
    cheap = argon2.PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)
    other = cheap.hash(b"nobody's")
    monkeypatch.setattr(passwords, "_hasher", lambda: cheap)
    monkeypatch.setattr(passwords, "_other", lambda: other)


@pytest.fixture
def site(app):
    """A server on which nobody has an account."""
    site = app.state.site
    with site.store.database.writing() as connection:
        for table in (INVITATION, LEARNER):
            connection.execute(delete(table))
    site.patience = Patience()
    return site


@pytest.fixture
def manager(app, site):
    """The first one, who manages."""
    found = Somebody(app)
    found.join(f"/invited?key={site.store.accounts.invite(manages=True)}", "Farida")
    return found


@pytest.fixture
def learner(app, manager):
    """Somebody whom they have invited."""
    found = Somebody(app)
    found.join(manager.link(), "রহিম উদ্দিন")
    return found


def cookie(somebody) -> str:
    return somebody.browser.cookies["quizgen"]


def count(site, table) -> int:
    with site.store.database.reading() as connection:
        return connection.execute(select(func.count()).select_from(table)).scalar_one()


def test_who_has_not_signed_in_sees_where_to_do_so_and_nothing_else(app, site):
    stranger = Somebody(app)
    for address in (
        "/",
        "/exam",
        "/progress",
        "/progress/export",
        "/q/x",
        "/people",
        "/account",
        "/nothing",
    ):
        answer = stranger.browser.get(address, follow_redirects=False)
        assert answer.status_code == 303, address
        assert answer.headers["location"].startswith("/sign-in?to=%2F"), address
    assert "Sign in" in stranger.get("/").text
    assert "<nav" not in stranger.page
    assert stranger.post("/practice", template="rgb-to-hsv").status_code == 403
    assert stranger.browser.get("/static/app.css").status_code == 200
    assert count(site, ATTEMPT) == 0


def test_from_the_first_invitation_to_a_question(manager, site):
    page = manager.get("/").text
    assert '<bdi class="me">Farida</bdi>' in page
    assert 'href="/people"' in page
    asked = manager.post("/practice", template="point-to-image-plane")
    assert asked.url.path.startswith("/q/")
    assert site.store.accounts.managed()
    manager.post("/sign-out")
    assert "Sign in" in manager.get("/").text
    assert manager.sign_in("farida").url.path == "/", "capitals do not count"


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


def test_what_somebody_did_is_theirs(manager, learner):
    at = learner.post("/practice", template="point-to-image-plane").url.path
    learner.post(f"{at}/1", a=["1", "2"])
    learner.post("/progress/exam", exam="2030-01-02")
    assert "2030-01-02" in learner.get("/progress").text
    assert "2030-01-02" not in manager.get("/progress").text
    assert at.encode()[3:] in learner.browser.get("/progress/export").content
    assert at.encode()[3:] not in manager.browser.get("/progress/export").content
    assert manager.get(at).status_code == 404


def addresses(app, place: str, number: str) -> list[tuple[str, str]]:
    """Every route whose address holds a name of something, for something of somebody else."""
    found = []
    for route in app.routes:
        path = getattr(route, "path", "")
        if "{attempt}" in path or "{sitting}" in path:
            path = re.sub(r"\{(attempt|sitting)\}", place, path).replace("{part}", number)
            path = path.replace("{number}", number)
            found += [(method, path) for method in route.methods - {"HEAD"}]
    return found


def test_nobody_reaches_what_belongs_to_another_account(app, site, manager, learner):
    attempt = learner.post("/practice", template="point-to-image-plane").url.path
    sitting = learner.post("/exam", blueprint="trial").url.path
    learner.post(sitting, **{"on-1a": "", "a-1a": "5"})
    with site.store.database.reading() as connection:
        before = [connection.execute(select(table)).all() for table in (ATTEMPT, ANSWER, LEARNER)]
    tried = addresses(app, attempt[3:], "1") + addresses(app, sitting[6:], "1")
    assert len(tried) >= 20
    manager.get("/")
    sent = {
        "token": manager.token,
        "a": ["7", "8"],
        "on-1a": "",
        "a-1a": "6",
        "do": "hand-in",
        "share": "all",
    }
    for method, address in tried:
        answer = manager.browser.request(method, address, data=sent if method == "POST" else None)
        assert answer.status_code == 404, (method, address)
    with site.store.database.reading() as connection:
        after = [connection.execute(select(table)).all() for table in (ATTEMPT, ANSWER, LEARNER)]
    assert after == before


def test_who_does_not_manage_cannot(app, site, manager, learner):
    person = site.store.accounts.people()[0].id
    assert 'href="/people"' not in learner.get("/").text
    paths = [route.path for route in app.routes if getattr(route, "path", "").startswith("/people")]
    assert len(paths) >= 7
    for path in paths:
        address = path.replace("{person}", str(person))
        if not address.endswith(("/invite", "/withdraw", "/name", "/password", "/remove")):
            assert learner.browser.get(address).status_code == 403, address
        else:
            sent = {"token": learner.token, "name": "X", "sure": "1", "manages": "1"}
            assert learner.browser.post(address, data=sent).status_code == 403, address
    assert [one.name for one in site.store.accounts.people()] == ["Farida", "রহিম উদ্দিন"]
    assert count(site, INVITATION) == 0


def test_an_invitation_is_good_once(app, site, manager):
    link = manager.link()
    first, second = Somebody(app), Somebody(app)
    second.get(link)
    assert first.join(link, "Ayesha").url.path == "/"
    sent = {"name": "Bela", "password": PASSWORD, "again": PASSWORD}
    assert second.post(link, **sent).status_code == 410
    assert second.get(link).status_code == 410
    assert "has been used" in second.page
    assert {one.name for one in site.store.accounts.people()} == {"Farida", "Ayesha"}


def test_of_many_hands_one_uses_an_invitation(site):
    accounts = site.store.accounts
    token = accounts.invite()
    with ThreadPoolExecutor(8) as threads:
        made = list(threads.map(lambda n: accounts.join(token, f"N{n}", "hash", {}), range(8)))
    assert len([one for one in made if one]) == 1
    assert len(accounts.people()) == 1


@pytest.mark.parametrize("key", ["", "x", "0" * 32, "%00", "é"])
def test_no_other_key_invites(app, site, key):
    assert Somebody(app).get(f"/invited?key={key}").status_code == 410


def test_an_invitation_can_be_withdrawn_and_grows_old(app, site, manager):
    link, old = manager.link(), manager.link()
    name = re.findall(r'name="invitation" value="(\w+)"', manager.page)
    assert len(name) == 2
    assert all(one not in link + old for one in name)
    manager.post("/people/withdraw", invitation=name[0])
    with site.store.database.writing() as connection:
        connection.execute(update(INVITATION).values(until=time.time() - 1))
    assert {Somebody(app).get(one).status_code for one in (link, old)} == {410}


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


def test_no_form_of_an_account_is_taken_without_its_token(app, site, manager):
    person = site.store.accounts.people()[0].id
    link = manager.link()
    before = [count(site, table) for table in (ACCOUNT, INVITATION, SESSION)]
    posts = [
        route.path.replace("{person}", str(person))
        for route in accounts.ROUTES
        if "POST" in route.methods
    ]
    assert len(posts) == 9
    for address in [*posts, link]:
        for sent in ({}, {"token": ""}, {"token": "0" * 64}):
            form = {"name": "Bela", "password": PASSWORD, "again": PASSWORD, "sure": "1", **sent}
            assert manager.browser.post(address, data=form).status_code == 403, address
    assert [count(site, table) for table in (ACCOUNT, INVITATION, SESSION)] == before
    assert manager.get("/").url.path == "/"


def test_names_that_cannot_be(app, manager, site):
    link = manager.link()
    found = Somebody(app)
    for name in (
        "",
        "   ",
        "x" * 61,
        "a\u202eb",
        "a\u0007b",
        "\u200b",
        "....",
        "FARIDA",
        "me",
        "Ｆarida",
    ):
        answer = found.join(link, name)
        assert answer.status_code == 400, name
        assert 'role="alert"' in answer.text
    assert found.join(link, "Bela", password="short").status_code == 400
    assert found.join(link, "Bela", again="another one").status_code == 400
    assert found.join(link, "Bela").url.path == "/"


def test_the_language_changes_where_a_form_was_answered(manager, site):
    person = site.store.accounts.people()[0].id
    for address in ("/people/invite", f"/people/{person}/password", f"/people/{person}/name"):
        manager.get("/people")
        manager.post(address, name="")
        back = re.search(r'name="back" value="([^"]*)"', manager.page)[1]
        assert manager.post("/settings", lang="bn", back=back).status_code == 200, address


@pytest.mark.parametrize(
    "name", ["<b>x</b>\"'&", "{{ 7*7 }}", "عبد الرحمن", "ক্‌ষ", "W" * 60, "x' OR '1'='1"]
)
def test_names_stay_text(app, manager, site, name):
    found = Somebody(app)
    assert found.join(manager.link(), name).url.path == "/"
    for page in (found.get("/account").text, manager.get("/people").text):
        assert (
            f"<bdi>{html.escape(name).replace('&#x27;', '&#39;').replace('&quot;', '&#34;')}</bdi>"
            in page
        )
        assert "<b>x" not in page
        assert ">49<" not in page
    found.post("/sign-out")
    assert found.sign_in(name).url.path == "/"


def test_wrong_passwords_have_to_wait_and_nobody_else_does(app, site, manager, learner):
    now = [100.0]
    site.patience = Patience(lambda: now[0])
    thief = Somebody(app)
    for _ in range(5):
        answer = thief.sign_in("Farida", "guess guess")
        assert answer.status_code == 403
        assert "do not belong together" in answer.text
    waits = []
    for _ in range(12):
        answer = thief.sign_in("Farida", PASSWORD)
        assert answer.status_code == 429, "not even the right one"
        waits.append(int(answer.headers["retry-after"]))
        now[0] += waits[-1]
        assert thief.sign_in("FARIDA", "guess guess").status_code == 403
    assert waits[:4] == [1, 2, 4, 8]
    assert max(waits) == 300
    other = Somebody(app)
    assert other.sign_in("রহিম উদ্দিন").url.path == "/", "another name from the same address"
    elsewhere = TestClient(app, ADDRESS, client=("192.168.1.77", 1))
    owner = Somebody(app)
    owner.browser = elsewhere
    assert owner.sign_in("Farida").url.path == "/", "the same name from another address"
    assert manager.get("/").status_code == 200
    now[0] += 301
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
    assert "$argon2id$" in site.store.accounts.known("Farida")[1]


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


def test_those_who_manage_rename_renew_and_remove(app, site, manager, learner):
    learner.post("/practice", template="point-to-image-plane")
    person = next(one.id for one in site.store.accounts.people() if not one.manages)
    assert manager.get(f"/people/{person}").status_code == 200
    assert manager.post(f"/people/{person}/name", name="FARIDA").status_code == 400
    assert manager.post(f"/people/{person}/name", name="Rahim").url.path == "/people"
    assert '<bdi class="me">Rahim</bdi>' in learner.get("/").text
    link = manager.link(f"/people/{person}/password")
    forgetful = Somebody(app)
    forgetful.get(link)
    assert 'name="name"' not in forgetful.page
    new = {"password": "sechs blaue Birnen", "again": "sechs blaue Birnen"}
    assert forgetful.post(link, **new).url.path == "/"
    assert forgetful.get(link).status_code == 410
    assert learner.get("/").url.path == "/sign-in"
    assert learner.sign_in("rahim", new["password"]).url.path == "/"
    manager.get(f"/people/{person}")
    assert manager.post(f"/people/{person}/remove").status_code == 400
    assert manager.post(f"/people/{person}/remove", sure="1").url.path == "/people"
    assert learner.get("/").url.path == "/sign-in"
    assert count(site, ATTEMPT) == 0
    myself = site.store.accounts.people()[0].id
    assert manager.post(f"/people/{myself}/remove", sure="1").status_code == 400
    assert count(site, ACCOUNT) == 1
    for nobody in ("0", "999999", "x", "1%00"):
        assert manager.get(f"/people/{nobody}").status_code in {400, 404}


def test_a_database_that_does_not_answer_is_said(manager, site, monkeypatch):
    def away(*_):
        raise OperationalError("SELECT 1", {"typed": PASSWORD}, OSError("gone"))

    monkeypatch.setattr(site.store.accounts, "people", away)
    answer = manager.get("/people")
    assert answer.status_code == 503
    assert "The database does not answer" in answer.text
    monkeypatch.setattr(site.store.accounts, "signed_in", away)
    answer = manager.browser.get("/")
    assert answer.status_code == 503
    assert "The database does not answer" in answer.text


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


@pytest.mark.parametrize(
    ("host", "status"),
    [("192.168.1.5:8000", 200), ("10.0.0.1", 200), ("[fe80::1]:8000", 200), ("localhost", 200),
     ("evil.example", 400), ("192.168.1.5.evil.example", 400), ("", 400), ("[::1", 400), ("1:2:3", 400)],
)  # fmt: skip
def test_numbers_are_served_and_names_that_were_asked_for(app, host, status):
    assert TestClient(app, ADDRESS).get("/sign-in", headers={"host": host}).status_code == status


def test_names_that_were_asked_for_are_served():
    named = Settings("sqlite://", behind_proxy=True, names=("quiz.school.example",))
    assert named.accounts
    assert named.serves("quiz.school.example")
    assert not named.serves("school.example")
    assert named.place(8000) == "https://quiz.school.example"
    alone = Settings("sqlite://")
    assert not alone.accounts
    assert not alone.serves("192.168.1.5")
