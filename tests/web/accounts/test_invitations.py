"""Links that invite, once, and the names under which people come in."""

from __future__ import annotations

import html
import re
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
from people import PASSWORD, Somebody
from sqlalchemy import update

from quizgen.store.schema import INVITATION

pytestmark = pytest.mark.both_databases


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
    assert sorted(Somebody(app).get(one).status_code for one in (link, old)) == [200, 410]
    with site.store.database.writing() as connection:
        connection.execute(update(INVITATION).values(until=time.time() - 1))
    assert {Somebody(app).get(one).status_code for one in (link, old)} == {410}


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
