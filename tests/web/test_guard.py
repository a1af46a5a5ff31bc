"""Who is let in, and what a page may load."""

from __future__ import annotations

import re

import pytest


def test_only_the_printed_address_lets_in(visitor, settings):
    assert visitor.get("/").status_code == 403
    assert visitor.get("/enter?key=wrong").status_code == 403
    assert visitor.get("/").status_code == 403
    entered = visitor.get(f"/enter?key={settings.token}", follow_redirects=False)
    assert entered.status_code == 303
    assert "httponly" in entered.headers["set-cookie"].lower()
    assert "samesite=lax" in entered.headers["set-cookie"].lower()
    assert visitor.get("/").status_code == 200


@pytest.mark.parametrize("host", ["evil.example", "evil.example:80", "127.0.0.1.evil.example", ""])
def test_no_other_name_of_this_machine_is_served(client, host):
    assert client.get("/", headers={"host": host}).status_code == 400


@pytest.mark.parametrize(
    "headers",
    [
        {"sec-fetch-site": "cross-site"}, {"sec-fetch-site": "same-site"},
        {"origin": "http://evil.example"}, {"origin": "null"},
    ],
)  # fmt: skip
def test_pages_of_others_post_nothing(client, token, headers):
    sent = {"token": token, "lang": "bn", "back": "/"}
    assert client.post("/settings", data=sent, headers=headers).status_code == 403
    assert client.post("/settings", data=sent).status_code == 200


def test_a_form_without_its_token_is_refused(client, token):
    assert client.post("/settings", data={"lang": "bn"}).status_code == 403
    assert (
        client.post("/settings", data={"lang": "bn", "token": token[:-1] + "x"}).status_code == 403
    )


def test_what_is_too_long_is_refused(client, token):
    assert client.post("/settings", content=b"x" * 1_000_001).status_code == 413
    long = {"token": token, "lang": "en", "back": "/" + "x" * 10_001}
    assert client.post("/settings", data=long).status_code == 400


@pytest.mark.parametrize("back", ["//evil.example", "https://evil.example", "/\\evil.example"])
def test_going_back_stays_here(client, token, back):
    sent = {"token": token, "lang": "en", "back": back}
    answer = client.post("/settings", data=sent, follow_redirects=False)
    assert answer.headers["location"] == "/"


@pytest.mark.parametrize(
    ("address", "headers"),
    [
        ("/", {}), ("/", {"host": "evil.example"}), ("/enter?key=wrong", {}), ("/%00", {}),
        ("/", {"content-length": "x"}), ("/", {"content-length": "1000001"}),
    ],
)  # fmt: skip
def test_who_is_refused_reads_why_in_every_language(visitor, address, headers):
    english, bangla, german = visitor.get(address, headers=headers).text.splitlines()
    assert re.fullmatch(r"[ -~]+\.", english)
    assert re.search(r"[\u0980-\u09ff].*।$", bangla)
    assert re.search(r"[äöüß]|Server|Das war", german)


def test_pages_load_scripts_of_their_own_alone(client):
    policy = dict(
        part.strip().split(" ", 1)
        for part in client.get("/").headers["content-security-policy"].split(";")
    )
    assert policy["default-src"] == "'none'"
    assert policy["script-src"] == "'self'"
    assert policy["frame-ancestors"] == "'none'"
