"""The names under which a server for several people answers."""

from __future__ import annotations

import pytest
from people import ADDRESS
from starlette.testclient import TestClient

from quizgen.web.settings import ServerSettings


@pytest.mark.parametrize(
    ("host", "status"),
    [("192.168.1.5:8000", 200), ("10.0.0.1", 200), ("[fe80::1]:8000", 200), ("localhost", 200),
     ("evil.example", 400), ("192.168.1.5.evil.example", 400), ("", 400), ("[::1", 400), ("1:2:3", 400)],
)  # fmt: skip
def test_numbers_are_served_and_names_that_were_asked_for(app, host, status):
    assert TestClient(app, ADDRESS).get("/sign-in", headers={"host": host}).status_code == status


def test_names_that_were_asked_for_are_served():
    named = ServerSettings("sqlite://", behind_proxy=True, names=("quiz.school.example",))
    assert named.accounts
    assert named.is_own_name("quiz.school.example")
    assert not named.is_own_name("school.example")
    assert named.base_url(8000) == "https://quiz.school.example"
    at_home = ServerSettings("sqlite://", phone=True)
    assert at_home.base_url(8000) == "http://127.0.0.1:8000"
    assert ServerSettings("sqlite://", host="::1").base_url(8000) == "http://[::1]:8000"
    alone = ServerSettings("sqlite://")
    assert not alone.accounts
    assert not alone.is_own_name("192.168.1.5")
