"""One learner, or somebody at the door, who means to shut out or hold up the others."""

from __future__ import annotations

import re

import argon2
import pytest
from people import ADDRESS, Somebody
from starlette.testclient import TestClient

from quizgen.store.schema import ANSWER
from quizgen.web import passwords
from quizgen.web.app import create_app
from quizgen.web.passwords import PasswordLimits
from quizgen.web.settings import ServerSettings
from quizgen.web.state import QUOTAS


@pytest.fixture(scope="module")
def app(tmp_path_factory):
    """A server on which people sign in."""
    file = tmp_path_factory.mktemp("data") / "learning.sqlite3"
    app = create_app(ServerSettings(f"sqlite:///{file}", host="0.0.0.0", workers=1))
    with TestClient(app, ADDRESS):
        yield app


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """Passwords that take no time."""
    cheap = argon2.PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)
    monkeypatch.setattr(passwords, "_make_hasher", lambda: cheap)


@pytest.fixture
def site(app):
    found = app.state.site
    found.password_limits = PasswordLimits(lambda: 0.0)
    return found


@pytest.fixture
def join(app, site):
    """Lets somebody join whom nobody has heard of before."""

    def joined(name: str) -> Somebody:
        found = Somebody(app)
        found.join(f"/invited?key={site.store.accounts.invite()}", name)
        return found

    return joined


def from_elsewhere(app, number: int) -> Somebody:
    found = Somebody(app)
    found.browser = TestClient(app, ADDRESS, client=(f"10.0.{number // 250}.{number % 250}", 1))
    return found


def test_wrong_passwords_of_others_never_keep_out_who_has_signed_in_before(app, join):
    owner = join("Farida")
    owner.post("/sign-out")
    thief = Somebody(app)
    for _ in range(10):  # at the same address
        thief.sign_in("Farida", "guess guess")
    for number in range(60):  # and everywhere else
        from_elsewhere(app, number).sign_in("Farida", "guess guess")
    assert Somebody(app).sign_in("Farida").status_code == 429, "a browser that nobody knows waits"
    assert owner.sign_in("Farida").url.path == "/"


def test_a_browser_that_is_known_for_one_is_not_for_another(app, join):
    join("Karim")
    thief = join("Thief")
    thief.post("/sign-out")
    found = [thief.sign_in("Karim", "guess guess").status_code for _ in range(6)]
    assert found == [403] * 5 + [429]
    thief.browser.cookies.set("quizgen-browser", "x.y", domain="192.168.1.5")
    assert thief.sign_in("Karim").status_code == 429
    assert from_elsewhere(app, 1).sign_in("Karim").url.path == "/"


@pytest.mark.slow
def test_one_address_cannot_try_one_password_at_every_name(app, join):
    found = [
        Somebody(app).sign_in(f"name {number}", "password1").status_code for number in range(102)
    ]
    assert found == [403] * 100 + [429] * 2
    join("Salma")
    assert from_elsewhere(app, 1).sign_in("Salma").url.path == "/"


def test_nothing_is_kept_under_a_part_that_the_paper_has_not(join, site):
    learner = join("Nadia")
    learner.get("/exam")
    page = learner.post("/exam", blueprint="trial")
    at, part = page.url.path, re.search(r'<fieldset data-part="(\w+)"', page.text)[1]
    assert learner.post(at, **{f"on-{part}": "", f"a-{part}": "7"}).status_code == 200
    for name in ("9999zzzz99", "77", part + "z"):
        sent = {f"on-{name}": "", f"a-{name}": "x" * 9000, f"on-{part}": "", f"a-{part}": "8"}
        assert learner.post(at, **sent).status_code == 400
        assert learner.post(at, **sent, do="hand-in").status_code == 400
    long = {f"on-{part}": "", f"a-{part}": ["x" * 9000] * 3}
    assert learner.post(at, **long).status_code == 413
    with site.store.database.reading() as connection:
        kept = connection.execute(ANSWER.select()).all()
    assert [(row.part, row.fields) for row in kept] == [(part, ["7"])]


@pytest.mark.parametrize(
    ("what", "at", "sent"),
    [("exam", "/exam", {"blueprint": "trial"}),
     ("practice", "/practice", {"template": "point-to-image-plane"})],
)  # fmt: skip
def test_one_learner_begins_only_so_much(join, site, what, at, sent):
    greedy, modest = join(f"Greedy at {what}"), join(f"Modest at {what}")
    session = site.store.accounts.signed_in(greedy.browser.cookies["quizgen"])
    for _ in range(QUOTAS[what][0]):
        site.spend_quota(what, session.id)
    greedy.get("/exam")
    refused = greedy.post(at, **sent)
    assert refused.status_code == 429
    assert 0 < int(refused.headers["retry-after"]) <= QUOTAS[what][1]
    assert "in a few minutes" in refused.text
    modest.get("/exam")
    assert modest.post(at, **sent).status_code == 200
