"""The names under which a server for several people answers."""

from __future__ import annotations

import pytest
from people import ADDRESS
from starlette.testclient import TestClient

from quizgen.web.settings import Settings


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
