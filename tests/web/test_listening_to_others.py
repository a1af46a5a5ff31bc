"""`quizgen serve --host`: a server in a process of its own, and what it writes to its log."""

from __future__ import annotations

import re

import httpx2
import pytest
from click.testing import CliRunner
from served import Served

from quizgen.cli.main import root_group

pytestmark = pytest.mark.slow  # servers in processes of their own

PASSWORDS = ("drei gelbe Bohnen", "geheimes Wort")
TYPED = ("98765.4321", "abweichend")


@pytest.fixture
def started(database):
    """Starts servers of one database."""
    address, running = database(), []

    def start(*more: str) -> Served:
        running.append(Served(address, *more))
        return running[-1]

    yield start
    for server in running:
        server.kill()


def token(page) -> str:
    return re.search(r'name="token" value="(\w+)"', page.text)[1]


def test_the_first_who_comes_manages_and_the_log_holds_no_secret(started):
    server = started("--host", "0.0.0.0")
    link = server.entrance
    assert re.fullmatch(r"http://[\d.]+:\d+/invited\?key=[\w-]{32}", server.printed)
    secrets = {*PASSWORDS, *TYPED}
    with httpx2.Client(follow_redirects=True, timeout=60) as browser:
        page = browser.get(link)
        secrets.add(token(page))
        sent = {
            "token": token(page),
            "name": "Farida",
            "password": PASSWORDS[0],
            "again": PASSWORDS[0],
        }
        page = browser.post(link, data=sent)
        assert page.url.path == "/"
        start = str(page.url)
        secrets |= {token(page), *browser.cookies.values()}
        invited = browser.post(f"{start}people/invite", data={"token": token(page)})
        secrets.add(re.search(r"invited\?key=([\w-]+)", invited.text)[1])
        page = browser.post(
            f"{start}practice", data={"token": token(page), "template": "point-to-image-plane"}
        )
        browser.post(f"{page.url}/1", data={"token": token(page), "a": TYPED})
        browser.post(f"{start}settings", content=b"token=%ff&a=" + TYPED[0].encode())
        browser.get(f"{start}q/{TYPED[1]}?password={PASSWORDS[1]}")
        browser.post(f"{start}sign-out", data={"token": token(page)})
        page = browser.get(start)
        sent = {"token": token(page), "name": "Farida", "password": PASSWORDS[1]}
        assert browser.post(f"{start}sign-in", data=sent).status_code == 403
    log = server.end()
    assert [one for one in secrets if one in log] == []
    events = [line.split()[2:4] for line in log.splitlines()]
    assert events == [["invitation", "used"], ["link", "made"], ["password", "wrong"]]


def test_a_server_that_has_a_manager_invites_when_it_is_told_to(started):
    server = started("--host", "0.0.0.0")
    link = server.entrance
    with httpx2.Client(follow_redirects=True, timeout=60) as browser:
        page = browser.get(link)
        sent = {
            "token": token(page),
            "name": "Farida",
            "password": PASSWORDS[0],
            "again": PASSWORDS[0],
        }
        assert browser.post(link, data=sent).url.path == "/"
    server.end()
    server = started("--behind-proxy", "--name", "quiz.school.example")
    assert server.printed == "https://quiz.school.example"
    here = f"{server.address}/sign-in"
    asked = {"host": "quiz.school.example", "x-forwarded-proto": "https"}
    assert "secure" in httpx2.get(here, headers=asked).headers["set-cookie"].lower()
    assert httpx2.get(here, headers={"host": "x.example"}).status_code == 400
    server.end()
    assert "/invited?key=" in started("--behind-proxy", "--invite").printed


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--host", "0.0.0.0", "--author"), "--author"),
        (("--invite",), "--invite"),
        (("--host", "no.such.place.invalid"), "no.such.place.invalid"),
        (("--host", "192.0.2.1"), "192.0.2.1, port"),
        (("--database", "postgres://me:geheim@h/x"), "an address is"),
    ],
)
def test_what_cannot_be_is_said_in_a_line(tmp_path, options, said):
    database = () if "--database" in options else ("--database", f"sqlite:///{tmp_path / 'x'}")
    found = CliRunner().invoke(root_group, ["serve", "--no-open", *database, *options])
    assert found.exit_code != 0
    told = found.output + str(found.exception)
    assert said in told
    assert "geheim" not in told
