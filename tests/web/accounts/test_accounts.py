"""What people who sign in reach: what is theirs, and all of it for those who manage."""

from __future__ import annotations

import re

import pytest
from people import PASSWORD, Somebody
from sqlalchemy import func, select
from sqlalchemy.exc import OperationalError

from quizgen.store.schema import ACCOUNT, ANSWER, ATTEMPT, INVITATION, LEARNER, SESSION
from quizgen.web import accounts

pytestmark = pytest.mark.both_databases


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
    assert site.store.accounts.has_manager()
    manager.post("/sign-out")
    assert "Sign in" in manager.get("/").text
    assert manager.sign_in("farida").url.path == "/", "capitals do not count"


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
