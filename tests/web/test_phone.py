"""Going on with a phone: one code lets in one device, as the same learner."""

from __future__ import annotations

import html
import re
import time
from urllib.parse import urlsplit

import pytest
from served import Served
from starlette.testclient import TestClient

from quizgen.web import state
from quizgen.web.app import create_app
from quizgen.web.auth import COOKIE, csrf_token
from quizgen.web.settings import EVERYWHERE, ServerSettings

THERE = "http://192.168.0.7:8000"


@pytest.fixture(scope="module")
def site(database):
    app = create_app(ServerSettings(database(), host=EVERYWHERE, phone=True, workers=1))
    with TestClient(app, "http://127.0.0.1:8000") as laptop:
        laptop.get(f"/enter?key={app.state.site.settings.token}")
        yield laptop


def scanned(laptop) -> str:
    """The path that a phone opens after scanning."""
    token = csrf_token(laptop.cookies[COOKIE])
    page = laptop.post("/phone", data={"token": token}).text
    assert "<svg" in page
    address = urlsplit(html.unescape(re.search(r'class="typed">([^<]*)<', page)[1]))
    return f"{address.path}?{address.query}"


@pytest.fixture
def phone(site):
    return TestClient(site.app, THERE)


def test_a_code_lets_in_one_device_once_as_the_same_learner(site, phone):
    way = scanned(site)
    assert phone.get("/").status_code == 403
    assert phone.get(way).status_code == 200
    assert TestClient(site.app, THERE).get(way).status_code == 403
    token = csrf_token(phone.cookies[COOKIE])
    phone.post("/tonight", data={"token": token, "minutes": "60"})
    assert 'value="60" aria-pressed="true"' in site.get("/").text


def test_a_new_code_ends_the_one_before(site, phone):
    first, _ = scanned(site), scanned(site)
    assert phone.get(first).status_code == 403


def test_a_code_ends_after_its_time(site, phone, monkeypatch):
    way, now = scanned(site), time.monotonic()
    monkeypatch.setattr(state.time, "monotonic", lambda: now + state.SCAN_SECONDS + 1)
    assert phone.get(way).status_code == 403


def test_other_devices_are_signed_out(site, phone):
    phone.get(scanned(site))
    site.post("/phone/end", data={"token": csrf_token(site.cookies[COOKIE])})
    assert phone.get("/").status_code == 403
    assert site.get("/").status_code == 200


def test_a_name_of_somebody_else_is_not_served(phone):
    assert phone.get("/", headers={"host": "evil.example"}).status_code == 400


@pytest.mark.slow
def test_the_command_listens_for_the_network_and_says_the_address_of_this_machine(database):
    server = Served(database(), "--phone")
    assert server.address.startswith("http://127.0.0.1:")
    server.kill()
